#!/usr/bin/env bash
# cmake/tidy.sh [file.cpp...]: clang-tidy on the files, or on all of core and app, and on the headers they include. With
# the debug build's compile commands: the optimised one's have flags that only g++ knows. Fails where it finds anything.
set -euo pipefail
# shellcheck source=cmake/setup.sh
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/setup.sh"

build debug
(($# > 0)) || mapfile -t -d '' files < <(find "$root/core" "$root/app" -name '*.cpp' -print0 | sort -z)
(($# == 0)) || files=("$@")
# Its counts of what was suppressed, a line a file, say nothing.
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-16 --quiet -p "$root/build/debug" 2> >(grep -v 'warnings\? generated\.$' >&2)
say "clang-tidy: ${#files[@]} files, nothing found"
