# shellcheck shell=bash
# Installing, building and testing, shared by run, check and .ci/run, which source it under set -euo pipefail.
# Talks on stderr: stdout is the program's.

root="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)"

say() { printf '%s\n' "$*" >&2; }

die() {
  say "$@"
  exit 1
}

# run_quietly LOG COMMAND...: keeps what the command prints in LOG and shows the end of it where the command fails.
run_quietly() {
  local log="$1"
  shift
  "$@" >"$log" 2>&1 </dev/null && return
  tail -n 40 -- "$log" >&2
  return 1
}

# install_packages run|check: installs what is missing of cmake/packages.txt. Asks nothing: where sudo would want a
# password and there is no terminal to type it on, it says what to install.
install_packages() {
  local purpose="$1" name only installed
  local -a wanted=() missing=() as_root=()
  while read -r name only; do
    [[ -z $name || $name == \#* ]] && continue
    [[ -z $only || $only == "$purpose" ]] && wanted+=("$name")
  done <"$root/cmake/packages.txt"

  installed="$(dpkg-query -W -f='[${Package} ${db:Status-Status}]' "${wanted[@]}" 2>/dev/null || true)"
  for name in "${wanted[@]}"; do
    [[ $installed == *"[$name installed]"* ]] || missing+=("$name")
  done
  ((${#missing[@]} == 0)) && return

  if ((EUID != 0)); then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; }; }; then
      as_root=(sudo)
    else
      die "Packages are missing and installing them takes root. As root: apt-get install --no-install-recommends ${missing[*]}"
    fi
  fi
  say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  mkdir -p -- "$root/build"
  local log="$root/build/packages.log"
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q -o DPkg::Lock::Timeout=300)
  # First the lists: what they name may be gone from the mirrors since they were fetched last, or they are not there.
  run_quietly "$log" "${apt[@]}" update ||
    die "The package lists could not be fetched. Is this Debian 12 with a network? (apt-get update, above)"
  run_quietly "$log" "${apt[@]}" install --no-install-recommends "${missing[@]}" ||
    die "The packages could not be installed (apt-get install, above)"
}

# show_progress: passes ninja's lines on as a single line that counts up; silent where nothing was to do. What is not
# a terminal gets one line in all.
show_progress() {
  local line started=""
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\ (.*)$ ]] || continue
    [[ ${BASH_REMATCH[3]} == "Re-checking globbed directories"* ]] && continue
    if [[ -t 2 ]]; then
      printf '\r\e[KBuilding %s/%s' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" >&2
    elif [[ -z $started ]]; then
      say "Building in build/${1}"
    fi
    started=yes
  done
  [[ -t 2 && -n $started ]] && printf '\r\e[K' >&2
  return 0
}

# build PRESET TARGET...: configures where that was not done yet or for another folder, and builds what changed.
build() {
  local preset="$1"
  shift
  local folder="$root/build/$preset"
  mkdir -p -- "$folder"
  # Two of these at once would write the same files. The lock ends with the subshell: what is started later is not held.
  (
    flock 9
    local -a fresh=()
    if [[ -f $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
      fresh=(--fresh)  # the whole tree was moved or copied
    fi
    if [[ ! -f $folder/build.ninja || $root/CMakePresets.json -nt $folder/build.ninja || ${#fresh[@]} -gt 0 ]]; then
      run_quietly "$folder/configure.log" cmake -S "$root" "${fresh[@]}" --preset "$preset" ||
        die "cmake --preset $preset failed (above)"
    fi
    ninja -C "$folder" "$@" 2>&1 </dev/null | tee -- "$folder/build.log" | show_progress "$preset" || {
      grep -v '^\[[0-9]*/[0-9]*\] ' -- "$folder/build.log" | tail -n 60 >&2
      die "The build failed (above; all of it in build/$preset/build.log)"
    }
  ) 9>"$folder/.lock"
}

# run_tests PRESET [ctest's words...]: every test of a build, as many at once as there are cores. Those of the real
# window, which take long, only where the words choose tests.
run_tests() {
  local preset="$1" word
  shift
  local -a manner=(-LE '^window$')
  for word in "$@"; do
    [[ $word == -[LRI]* || $word == --label-regex || $word == --tests-* || $word == --rerun-failed ]] && manner=()
  done
  [[ -t 1 ]] && manner+=(--progress)
  (cd -- "$root" && ctest --preset "$preset" --parallel "$(nproc)" --no-tests=error "${manner[@]}" "$@")
}
