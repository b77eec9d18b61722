#!/bin/sh
# Runs report_page.mjs in a work folder: run_report_page.sh WORK_FOLDER PAGE.html...
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1
shift
. "$here/browser_driver.sh"

CHROMIUM=$chromium exec node "$work/report_page.mjs" "$work/screenshots" "$@"
