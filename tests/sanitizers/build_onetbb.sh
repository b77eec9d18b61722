#!/usr/bin/env bash
# Builds Debian's own oneTBB under ThreadSanitizer into a folder: build_onetbb.sh FOLDER. A library built without
# it hides from the sanitizer who waits for whom, and every join of its threads would look like a race.
#
# The source comes by the ordinary apt, from wherever this machine gets its packages. Most machines list no
# source packages, so a list of them is derived in a folder of its own; the machine's lists stay as they are.
set -euo pipefail
prefix=$(realpath --canonicalize-missing "${1:?a folder to install to}")
[[ -e $prefix/lib/cmake/TBB/TBBConfig.cmake ]] && exit 0

work=$(mktemp --directory)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/parts "$work"/lists/partial "$work"/cache/archives/partial
shopt -s nullglob
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [[ -f $list ]] && sed -E 's/^deb(-src)?([[:space:]])/deb-src\2/' "$list" >"$work/parts/$(basename "$list" .list).list"
done
for list in /etc/apt/sources.list.d/*.sources; do
    sed -E 's/^Types:.*/Types: deb-src/' "$list" >"$work/parts/$(basename "$list")"
done
apt=(apt-get --quiet -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$work/parts"
    -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work/cache" -o "APT::Sandbox::User=$(id --user --name)")
cd "$work"
"${apt[@]}" update || echo "build_onetbb: not every list could be read; going on with those that could" >&2
if ! "${apt[@]}" source onetbb; then
    echo "build_onetbb: apt-get cannot fetch the source package onetbb; is there a network, and a Debian mirror" \
        "in /etc/apt?" >&2
    exit 1
fi

# Lighter optimisation than Debian's own keeps the stacks of reports whole.
cmake -S onetbb-*/ -B objects -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" \
    -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
    -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_INSTALL_PREFIX="$prefix"
cmake --build objects -j2
cmake --install objects >/dev/null
