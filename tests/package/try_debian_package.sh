#!/usr/bin/env bash
# Makes the Debian packages, unpacks them and uses what is in them: try_debian_package.sh BUILD_FOLDER WORK_FOLDER
# Exit code 77, ctest's "skipped", where the tools of Debian are missing.
set -euo pipefail
build=$1
work=$2
for tool in cpack dpkg-deb dpkg-shlibdeps; do
    if ! command -v "$tool" >/dev/null; then
        echo "Skipped: '$tool' is missing (Debian: apt-get install cmake dpkg-dev)."
        exit 77
    fi
done
rm -rf "$work"
mkdir -p "$work"

cpack --config "$build/CPackConfig.cmake" -B "$work" >"$work/messages" || { cat "$work/messages" >&2; exit 1; }
for name in capstan libcapstan-dev capstan-doc python3-capstan; do
    package=$(echo "$work/${name}"_*.deb)
    if [[ $name == python3-capstan && ! -e $package ]]; then continue; fi  # its packages were not there
    dpkg-deb --info "$package"
    dpkg-deb --extract "$package" "$work/$name"
    test -s "$work/$name/usr/share/doc/$name/copyright"
    grep -q "University of Washington" "$work/$name/usr/share/doc/$name/notices.txt"
done

needs() {  # package, what it must say that it needs
    local depends library
    depends=$(dpkg-deb --field "$(echo "$work/$1"_*.deb)" Depends)
    for library in "${@:2}"; do
        [[ $depends == *$library* ]] || { echo "$1 does not say that it needs $library: $depends" >&2; exit 1; }
    done
}
needs capstan libc6 libsqlite3-0 libtbb12
needs libcapstan-dev libeigen3-dev libhwy-dev libtbb-dev
test -s "$work/libcapstan-dev/usr/include/capstan/gap/diagnosis.h"
test ! -e "$work/capstan/usr/include"

test -s "$work/libcapstan-dev/usr/include/capstan/controller/capstan_observer.h"
test -s "$work/capstan/usr/share/capstan/matlab/+capstan/place.m"
if [[ -e $build/book/html/index.html ]]; then
    cp --recursive "$work/capstan-doc/usr/share/doc" "$work/capstan/usr/share/"
    test -s "$("$work/capstan/usr/bin/capstan" help --book)"
fi

root=$work/capstan
"$root/usr/bin/capstan" --version
"$root/usr/bin/capstan" study run "$root/usr/share/capstan/configs/quick.toml" --db "$work/quick.db" \
    --progress none -o "$work/advice"
head -5 "$work/advice"
if [[ -d $work/python3-capstan ]]; then
    needs python3-capstan "python3 (<<" python3-numpy libtbb12
    PYTHONPATH=$work/python3-capstan/usr/lib/python3/dist-packages /usr/bin/python3 -B \
        "$(dirname "${BASH_SOURCE[0]}")/use_python_package.py" "$root/usr/share/capstan/configs/recordings/viscous-pair.csv"
fi
