# Debian packages of capstan: the one list, and how to install what is missing. To be sourced.

build_packages=(
    g++ cmake ninja-build ccache
    libeigen3-dev libtbb-dev libsqlite3-dev libboost-dev libboost-program-options-dev
    librandom123-dev libhwy-dev libssl-dev libtomlplusplus-dev nlohmann-json3-dev libfmt-dev
    zlib1g-dev libbz2-dev liblz4-dev libzstd-dev libmatio-dev libhdf5-dev libminizip-dev
    libexpat1-dev nodejs npm
    pybind11-dev python3-dev python3-numpy mypy # the Python module and its stub; CAPSTAN_PYTHON=OFF builds without it
)
test_packages=(
    libgtest-dev libgmock-dev libbenchmark-dev liblapack-dev sqlite3 python3 chromium
    python3-rosbag python3-sensor-msgs python3-scipy python3-h5py python3-openpyxl lz4 zstd # they write the logs that the tests read
    octave # of the tests of +capstan
)
# For the book (ninja -C build book); its PDF also needs chromium.
book_packages=(
    python3-sphinx python3-myst-parser furo katex fonts-texgyre-math
    python3-nbconvert python3-ipykernel python3-matplotlib python3-pandas doxygen
)
# For the tests on a Slurm and a Grid Engine of their own, over ssh, with GNU parallel and with Snakemake, which are skipped
# without them.
slurm_packages=(slurmctld slurmd slurm-client munge gridengine-master gridengine-exec gridengine-client openssh-server iproute2
    parallel snakemake)

# For the fuzz targets, the thread sanitizer's own oneTBB, and the checks of the code.
fuzz_packages=(clang libclang-rt-14-dev)
thread_packages=(dpkg-dev)
check_packages=(clang-tidy cppcheck gcovr)

# Programs count however they were installed; a package that only brings programs is missing only without them.
package_is_there() {
    case $1 in
        g++ | cmake | ccache | npm | sqlite3 | python3 | chromium | lz4 | zstd | mypy | doxygen | octave) command -v "$1" >/dev/null && return ;;
        ninja-build) command -v ninja >/dev/null && return ;;
        nodejs) command -v node >/dev/null && return ;;
        clang) command -v clang++ >/dev/null && return ;;
        clang-tidy | cppcheck | gcovr) command -v "$1" >/dev/null && return ;;
    esac
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# Installs those of the named packages that are missing; does nothing, and asks for nothing, when all are there.
install_missing() {
    local missing=() package
    for package in "$@"; do
        package_is_there "$package" || missing+=("$package")
    done
    [[ ${#missing[@]} -eq 0 ]] && return
    if ! command -v apt-get >/dev/null; then
        echo "These Debian packages are missing, and there is no apt-get: ${missing[*]}" >&2
        echo "Install what they are called on this system, then try again." >&2
        return 1
    fi
    echo "Installing ${missing[*]}" >&2
    local as_root=(env DEBIAN_FRONTEND=noninteractive)
    if [[ $(id -u) -ne 0 ]]; then
        if ! command -v sudo >/dev/null; then
            echo "That needs root: run as root apt-get install ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo "${as_root[@]}")
    fi
    "${as_root[@]}" apt-get update >&2
    "${as_root[@]}" apt-get install --yes --no-install-recommends "${missing[@]}" >&2
}
