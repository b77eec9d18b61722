#!/bin/sh
# Runs report_page.mjs in a work folder: run_report_page.sh WORK_FOLDER PAGE.html...
# Exit code 77, ctest's "skipped", when the machine has no browser to open the pages with.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1
shift

chromium=${CHROMIUM:-/usr/bin/chromium}
for tool in node npm "$chromium"; do
    if ! command -v "$tool" >/dev/null 2>&1; then
        echo "Skipped: '$tool' is missing, so no browser can open the report (Debian: apt-get install chromium nodejs npm)."
        exit 77
    fi
done

# npm works on a copy, and only when the lock file has changed: the source folder stays as it is.
mkdir -p "$work"
if ! cmp -s "$here/package-lock.json" "$work/installed-lock.json"; then
    cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$work/"
    npm --prefix "$work" ci --ignore-scripts --loglevel=error
    cp "$here/package-lock.json" "$work/installed-lock.json"
fi
cp "$here/report_page.mjs" "$work/"
CHROMIUM=$chromium exec node "$work/report_page.mjs" "$work/screenshots" "$@"
