#!/usr/bin/env bash
# Makes the Debian package, unpacks it and runs what is in it: try_debian_package.sh BUILD_FOLDER WORK_FOLDER
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
package=$(echo "$work"/capstan_*.deb)
dpkg-deb --info "$package"
depends=$(dpkg-deb --field "$package" Depends)
for library in libc6 libsqlite3-0 libtbb12 libcpp-httplib0; do
    [[ $depends == *$library* ]] || { echo "The package does not say that it needs $library: $depends" >&2; exit 1; }
done
dpkg-deb --extract "$package" "$work/root"
"$work/root/usr/bin/capstan" --version
"$work/root/usr/bin/capstan" study run "$work/root/usr/share/capstan/configs/quick.toml" --db "$work/quick.db" \
    --progress none -o "$work/advice"
head -5 "$work/advice"
