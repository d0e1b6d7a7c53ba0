#!/usr/bin/env bash
# cmake/tidy.sh [file.cpp...]: clang-tidy on the files, or on all of core and app, and on the headers they include. With
# a debug build's compile commands: the optimised one's have flags that only g++ knows. All of them are read eight at a
# time, which takes a quarter of the time: most of it goes to what they include. Fails where it finds anything.
set -euo pipefail
# shellcheck source=cmake/setup.sh
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/setup.sh"

if (($# > 0)); then
  preset=debug
  files=("$@")
  build "$preset" build.ninja
else
  preset=tidy
  build "$preset" build.ninja
  mapfile -t files < <(
    sed -nE 's|^ *"file": "(.*)",?$|\1|p' "$root/build/$preset/compile_commands.json" |
      grep -E "^$root/((core|app)/|build/$preset/(core|app)/.*/Unity/)" | sort -u
  )
fi
# Its counts of what it suppressed in system headers say nothing. A minute is what the longest takes; but the solver
# behind bugprone-unchecked-optional-access goes by addresses, and once in a while meets an order that would take it all
# day with many loops and conditions around a std::optional. Another run has other addresses.
read_file() {
  local try status
  for try in 1 2 3 4; do
    status=0
    timeout 180 clang-tidy-16 --quiet --extra-arg=-Wno-unknown-warning-option -p "$1" "$2" 2>&1 || status=$?
    ((status == 124)) || return "$status"
    echo "clang-tidy took 3 minutes for $2 (try $try)"
  done
  return 1
}
export -f read_file
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$(nproc)" bash -c 'read_file "$@"' read_file "$root/build/$preset" 2>&1 |
  { grep --line-buffered -v ' generated\.$' >&2 || true; }
say "clang-tidy: nothing found in ${*:-core and app}"
