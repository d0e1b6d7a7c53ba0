#!/usr/bin/env bash
# cmake/tidy.sh [file.cpp...]: clang-tidy on the files, or on all of core and app, and on the headers they include. With
# the debug build's compile commands: the optimised one's have flags that only g++ knows. Fails where it finds anything.
set -euo pipefail
# shellcheck source=cmake/setup.sh
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/setup.sh"

build debug build.ninja
if (($# > 0)); then
  files=("$@")
else
  mapfile -t -d '' files < <(find "$root/core" "$root/app" -name '*.cpp' -print0 | sort -z)
fi
# Its counts of what it suppressed in system headers say nothing.
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-16 --quiet --extra-arg=-Wno-unknown-warning-option -p "$root/build/debug" 2>&1 |
  { grep -v ' generated\.$' >&2 || true; }
say "clang-tidy: ${#files[@]} files, nothing found"
