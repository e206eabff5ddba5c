# Sourced by demos/run and tests/run: what they need from Debian, and how they build.
# shellcheck shell=bash disable=SC2034
# What is installed or built is reported on standard error.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

library_packages=(g++ cmake ninja-build libeigen3-dev libbullet-dev libccd-dev)
demo_packages=(pkgconf libegl-dev libgl-dev libegl-mesa0 libgl1-mesa-dri libepoxy-dev libpng-dev libfreetype-dev fonts-dejavu-core libcli11-dev
    nlohmann-json3-dev libtinyobjloader-dev libtinyxml2-dev)
test_packages=(pkgconf xz-utils libgtest-dev libgmock-dev libbenchmark-dev python3-pip
    python3-cffi python3-numpy swig)
arm64_packages=(libc6-dev:arm64 libbullet-dev:arm64 libccd-dev:arm64 libgtest-dev:arm64 libgmock-dev:arm64
    libtinyobjloader-dev:arm64 libtinyxml2-dev:arm64)
bundle_packages=(dpkg-dev pkgconf python3)
bundle_sources=(bullet libccd)
windows_packages=(g++-mingw-w64-x86-64-posix wine64)
windows_sources=(googletest tinyxml2 tinyobjloader)
report_packages=(libode-dev gnuplot-nox fonts-dejavu-core)

say() { printf '%s\n' "$*" >&2; }
fail() {
    say "$(basename "$(dirname "$0")")/$(basename "$0"): $*"
    exit 1
}

# need PACKAGE... installs those that are missing; without any it touches neither network nor system.
need() {
    local package missing=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        command -v cmake >/dev/null && command -v ninja >/dev/null && return
        fail "this is not a Debian system. Please install what these Debian packages hold and run it again:
  $*
At least cmake 3.25 and ninja are missing; cmake will name the libraries that are."
    fi
    for package in "$@"; do
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true) == installed ]] ||
            missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    become_root "apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    say "Installing ${missing[*]}"
    "${as_root[@]}" apt-get update -qq >&2 || fail "apt-get update failed: is there a network?"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2 ||
        fail "apt-get could not install ${missing[*]}"
}

# need_sources NAME...: Debian's source packages, unpacked as build/sources/NAME; what is there is taken as it is. apt's
# settings stay as they are: it reads others, which name the same places, from build/sources.
need_sources() {
    local folder=$root/build/sources name list missing=() apt
    for name in "$@"; do
        [[ -d $folder/$name ]] || missing+=("$name")
    done
    ((${#missing[@]})) || return 0
    command -v apt-get >/dev/null ||
        fail "this is not a Debian system. Please put the sources of ${missing[*]} into $folder, a folder each"
    apt=(apt-get -qq -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$folder/apt/parts"
        -o "Dir::State::Lists=$folder/apt/lists" -o "APT::Sandbox::User=$(id -un)")
    mkdir -p "$folder/apt/parts" "$folder/apt/lists"
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [[ ! -f $list ]] || sed -n 's/^deb[[:blank:]]/deb-src /p' "$list" >"$folder/apt/parts/$(basename "$list" .list).list"
    done
    for list in /etc/apt/sources.list.d/*.sources; do
        [[ ! -f $list ]] || sed 's/^Types:.*/Types: deb-src/' "$list" >"$folder/apt/parts/$(basename "$list")"
    done
    say "Getting the sources of ${missing[*]}"
    "${apt[@]}" update >&2 || fail "apt-get update failed: is there a network?"
    for name in "${missing[@]}"; do
        mkdir -p "$folder/apt/$name"
        (cd "$folder/apt/$name" && "${apt[@]}" source "$name" >&2) || fail "apt-get could not get the sources of $name"
        mv "$folder/apt/$name"/*/ "$folder/$name"
    done
}

# need_architecture NAME: packages of another kind of processor can be installed from then on.
need_architecture() {
    command -v dpkg >/dev/null || fail "packages for $1 come from Debian alone"
    if dpkg --print-foreign-architectures | grep -qx "$1"; then return; fi
    become_root "dpkg --add-architecture $1"
    say "Adding packages for $1"
    "${as_root[@]}" dpkg --add-architecture "$1"
}

# become_root COMMAND: says it where nobody can. as_root is what comes before such a command.
as_root=()
become_root() {
    if (($(id -u) == 0)); then return; fi
    command -v sudo >/dev/null || fail "missing packages, and neither root nor sudo to install them. As root:
  $1"
    as_root=(sudo)
}

# Jobs at once: every core, but 1.5 GB for each.
job_count() {
    local kib='' limit cores
    cores=$(nproc)
    [[ ! -r /proc/meminfo ]] || kib=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
    if [[ -r /sys/fs/cgroup/memory.max ]]; then
        read -r limit </sys/fs/cgroup/memory.max || true
        [[ ! $limit =~ ^[0-9]+$ || -n $kib && $((limit / 1024)) -ge $kib ]] || kib=$((limit / 1024))
    fi
    if [[ -n $kib ]] && ((kib / 1572864 < cores)); then cores=$((kib / 1572864)); fi
    echo $((cores > 1 ? cores : 1))
}

# build PRESET "CONFIGURE OPTION..." [TARGET...]
build() {
    local preset=$1 options=$2 target=()
    shift 2
    (($#)) && target=(--target "$@")
    (
        cd "$root"
        # shellcheck disable=SC2086 # options are words
        cmake --preset "$preset" $options >&2
        cmake --build --preset "$preset" --parallel "$(job_count)" "${target[@]}" >&2
    ) || fail "the build of preset $preset failed"
}
