# Set-up shared by sim/run, tests/run and the scripts below tests/: packages, configuration, build. Sourced by bash; needs $root.
# shellcheck shell=bash disable=SC2034,SC2154

fail() {
  echo "$(basename "$(dirname "$0")")/$(basename "$0"): $*" >&2
  exit 1
}

# Arguments are checked before anything is installed or built, which can take an hour.
refuse() {
  echo "$(basename "$(dirname "$0")")/$(basename "$0"): $* (see --help)" >&2
  exit 2
}

require_file() { # what it is, path
  [ -e "$2" ] || refuse "$1: '$2' does not exist"
  [ ! -d "$2" ] || refuse "$1: '$2' is a folder; give a file"
  [ -f "$2" ] || refuse "$1: '$2' is a pipe or a device; give a plain file"
  [ -r "$2" ] || refuse "$1: '$2' cannot be read; its permissions are $(stat -Lc %A "$2")"
}

# Missions and sensors that ship may be given by their names.
require_mission() { # what it is, file or name
  [ -z "$(find "$root/sim/world/target/missions" -name "[0-9]_$2.toml" 2>/dev/null)" ] || return 0
  require_file "$1" "$2"
  grep -qE '^[[:space:]]*mesh[[:space:]]*=' "$2" ||
    refuse "$1: '$2' has no line like mesh = \"craft.stl\"; docs/own_spacecraft.md shows a mission file"
  local mesh
  mesh=$(sed -nE 's/^[[:space:]]*mesh[[:space:]]*=[[:space:]]*"([^"]*)".*/\1/p' "$2" | head -n 1)
  case $mesh in '' | parametric) return 0 ;; /*) ;; *) mesh=$(dirname "$2")/$mesh ;; esac
  require_file "the mesh of $2" "$mesh"
}

require_sensor() { # what it is, file or name
  [ "$2" = list ] || [ -f "$root/sim/world/sensor/descriptions/$2.json" ] || require_file "$1" "$2"
}

is_number() { [[ $1 =~ ^[+-]?[0-9]*\.?[0-9]+([eE][+-]?[0-9]+)?$ ]]; }
is_whole() { [[ $1 =~ ^(0|[1-9][0-9]*)$ ]]; }

is_one_of() { [[ " ${*:2} " == *" $1 "* ]]; } # word, list

# That an option has one value, of the kind that it needs. The limits are the program's, which checks them before it begins.
require_value() { # number, whole, folder or another; option, arguments from the option on
  local kind=$1 option=$2 value
  shift 2
  [ "$1" != "$option" ] || [ $# -gt 1 ] || refuse "$option needs a value"
  value=$(value_in "$option" "$@")
  [ -n "$value" ] || refuse "$option needs a value"
  case $kind in
    number) is_number "$value" || refuse "$option: must be a number, not '$value'" ;;
    whole) is_whole "$value" || refuse "$option: must be a whole number, not '$value'" ;;
    folder) [ ! -e "$value" ] || [ -d "$value" ] || refuse "$option: '$value' is not a folder" ;;
  esac
}

# "--name VALUE" and "--name=VALUE" as VALUE.
value_in() { # name, arguments from the option on
  case $2 in "$1="*) echo "${2#*=}" ;; *) echo "${3-}" ;; esac
}

# With the program's own check of its arguments, where Python is there already.
require_arguments_of() { # Python program, arguments...
  command -v python3 >/dev/null || return 0
  python3 -B "$@" --check-arguments || exit 2
}

# The Debian packages that the toolchain files name: require_program(VARIABLE PROGRAM PACKAGES).
packages_of_toolchains() {
  [ -d "${root-}/toolchains" ] || return 0
  sed -nE 's/^require_program\([^ ]+ [^ ]+ "?([^")]+)"?\)$/\1/p' "$root"/toolchains/*.cmake | tr ' ' '\n' | sort -u
}

# What the programs need; the tests and the training add theirs.
# Debian 12's packages. What each is for, and its name on other systems: docs/packages.md. A change here belongs there too.
packages_to_run=(g++ cmake ninja-build pkg-config libeigen3-dev cyclonedds-dev cyclonedds-tools libembree-dev
  libcli11-dev libdraco-dev libfmt-dev libmeshoptimizer-dev libpng-dev libssl-dev libtomlplusplus-dev
  nlohmann-json3-dev)
packages_to_export=("${packages_to_run[@]}" libonnx-dev libprotobuf-dev)
# The console in the browser: sim/run --watch.
packages_to_watch=("${packages_to_run[@]}" libcivetweb-dev libjs-dygraphs libjs-three)
packages_to_train=("${packages_to_run[@]}" libtorch-dev libgloo-dev libopenblas0-pthread)
# The preset dev: unit tests without training.
packages_to_develop=("${packages_to_watch[@]}" libgtest-dev libgmock-dev python3)
packages_to_test=("${packages_to_train[@]}" "${packages_to_develop[@]}" "${packages_to_export[@]}" libdnnl-dev
  chromium clang clang-format git openmpi-bin slurm-wlm valgrind)
packages_to_fuzz=("${packages_to_run[@]}" clang libcivetweb-dev libclang-rt-dev python3)
# The flight side only, with clang's counts of branches and conditions.
packages_to_cover=(g++ clang-19 libclang-rt-19-dev llvm-19 cmake ninja-build pkg-config libeigen3-dev libgtest-dev libgmock-dev python3)
packages_to_analyse=("${packages_to_run[@]}" libgtest-dev libgmock-dev clang clang-tidy cppcheck python3)
# The processors of the audit: compilers, emulators, and GoogleTest's sources to build it for them.
packages_to_audit=("${packages_to_run[@]}" gcc googletest python3
  $(packages_of_toolchains))

# Ends a job with all processes that it started, some of them as root, and then this script.
end_with() { # job
  trap '' INT TERM
  if [ -n "$1" ]; then
    { kill -TERM -- "-$1" || sudo -n kill -TERM -- "-$1" || kill -TERM "$1" || true; } 2>/dev/null
    wait "$1" 2>/dev/null || true
  fi
  printf '\n'
  fail "interrupted; run the same command again to continue"
}

# Runs a command with its output in a log. Prints the end of the log if the command fails.
quietly() { # what, log, command...
  local what=$1 log=$2 started=$SECONDS job=
  shift 2
  mkdir -p "$(dirname "$log")"
  # Background jobs of bash ignore Ctrl-C, so the trap ends them. The job has a process group of its own (set -m), which
  # contains all processes that it starts.
  trap 'end_with "$job"' INT TERM
  set -m
  "$@" </dev/null >"$log" 2>&1 &
  job=$!
  set +m
  while kill -0 "$job" 2>/dev/null; do
    [ -t 1 ] && printf '\r  %s, %d s ' "$what" $((SECONDS - started))
    sleep 0.2
  done
  local status=0
  wait "$job" || status=$?
  trap - INT TERM
  if [ "$status" -eq 0 ]; then
    if [ -t 1 ]; then printf '\r\033[K'; fi
    printf '  %s: done in %d s\n' "$what" $((SECONDS - started))
    return 0
  fi
  printf '\n'
  tail -n 25 "$log" >&2
  return 1
}

# Installs the packages that are missing. Uses neither apt nor the network if none is.
install_missing() { # package...
  command -v dpkg-query >/dev/null || fail "packages are installed on Debian only; on other systems install those of docs/packages.md and build with CMake, as described there"
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0

  echo "  Missing packages: ${missing[*]}"
  local as_root=(env DEBIAN_FRONTEND=noninteractive)
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "installing them needs root, and there is no sudo; as root: apt-get install ${missing[*]}"
    sudo -v || fail "sudo failed; as root: apt-get install ${missing[*]}"
    as_root=(sudo env DEBIAN_FRONTEND=noninteractive)
  fi
  quietly "reading package lists" "$root/build/log/apt_update.log" \
    "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 update || fail "apt-get update failed (see above); it needs network access"
  quietly "installing ${#missing[@]} packages and their dependencies" "$root/build/log/apt_install.log" \
    "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 install -y --no-install-recommends "${missing[@]}" ||
    fail "apt-get install failed (see above; the whole log: build/log/apt_install.log)"
}

# What a configuration rests on: the packages that are installed, the presets, and CMake's cache as it was left.
basis_of_configuration() { # folder
  {
    dpkg-query -W -f='${db:Status-Status} ${Package} ${Architecture} ${Version}\n' 2>/dev/null || true
    cat "$root/CMakePresets.json"
    cat "$1/CMakeCache.txt"
  } | cksum
}

cached() { # folder, name
  sed -nE "s/^$2:[A-Z]+=//p" "$1/CMakeCache.txt"
}

# Whether CMake can go on from a cache: not from one of a folder that was moved or copied, of a program that is gone, or of
# a configuration that was interrupted or made for another build program.
is_usable_cache() { # folder
  [ -f "$1/build.ninja" ] && [ -f "$1/CMakeCache.txt" ] || return 1
  [ "$(cached "$1" CMAKE_HOME_DIRECTORY)" -ef "$root" ] && [ "$(cached "$1" CMAKE_CACHEFILE_DIR)" -ef "$1" ] || return 1
  local variable program
  for variable in CMAKE_C_COMPILER CMAKE_CXX_COMPILER CMAKE_MAKE_PROGRAM; do
    program=$(cached "$1" "$variable")
    [ -z "$program" ] || command -v "$program" >/dev/null || return 1
  done
}

# The variables of a cache that name a file or folder of a package that is gone. CMake looks again for what it did not find,
# but not for what it found once.
gone_from_cache() { # folder
  local line name
  sed -nE '/^(CMAKE|TUMBLESIGHT)_/d; s/^([A-Za-z0-9_]+):(FILEPATH|PATH)=(\/.*)$/\1 \3/p' "$1/CMakeCache.txt" |
    while read -r name line; do [ -e "$line" ] || echo "$name"; done
}

# The presets release and train share a folder, so that training adds to what is built. Once configured, it stays.
folder_of_preset() { # preset
  case $1 in train) echo "$root/build/release" ;; *) echo "$root/build/$1" ;; esac
}

is_configured() { # preset, folder
  [ "$(cat "$2/.configured" 2>/dev/null)" = "$(basis_of_configuration "$2")" ] || return 1
  [ "$1" != train ] || [ "$(cached "$2" TUMBLESIGHT_TRAINING)" = ON ]
}

# Configures a preset of CMakePresets.json, unless that is done and nothing that it rests on has changed since: a package that
# has come adds what could not be built without it.
configure_preset() { # preset
  local folder options=() name
  folder=$(folder_of_preset "$1")
  if ! is_usable_cache "$folder"; then
    [ ! -f "$folder/CMakeCache.txt" ] || options=(--fresh)
  else
    ! is_configured "$1" "$folder" || return 0
    for name in $(gone_from_cache "$folder"); do options+=(-U "$name"); done
    # Training stays only as long as LibTorch does.
    if [ "$1" = release ] && [ "$(cached "$folder" TUMBLESIGHT_TRAINING)" = ON ] && [ ! -e "$(cached "$folder" Torch_DIR)" ]; then
      options+=(-D TUMBLESIGHT_TRAINING=OFF)
    fi
  fi
  rm -f "$folder/.configured"
  quietly "configuring" "$root/build/log/configure_$1.log" cmake -S "$root" --preset "$1" "${options[@]}" ||
    fail "cmake failed (see above; the whole log: build/log/configure_$1.log)"
  basis_of_configuration "$folder" >"$folder/.configured"
}

# Configures and builds a preset, or some targets of it. Prints nothing if all is up to date.
build_preset() { # preset, target...
  local folder
  folder=$(folder_of_preset "$1")
  configure_preset "$1"
  shift
  ninja -C "$folder" -n "$@" 2>/dev/null | grep -q 'no work to do' && return 0
  NINJA_STATUS='  building %f/%t, %es  ' ninja -C "$folder" -j "$(nproc)" "$@" || fail "the build failed (see above)"
}

# Allows one set-up at a time in a checkout; a second one waits for the first.
exclusively() { # command...
  mkdir -p "$root/build"
  exec 9>"$root/build/.lock"
  if ! flock -n 9; then
    echo "  Waiting for another set-up in this checkout to finish"
    flock 9
  fi
  "$@"
  exec 9>&-
}
