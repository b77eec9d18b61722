#!/bin/sh
# Runs book_pages.mjs in the work folder of the browser tests: run_book_pages.sh WORK_FOLDER BOOK_FOLDER
set -eu
tests=$(cd "$(dirname "$0")" && pwd)
here=$tests/../browser
work=$1
. "$here/browser_driver.sh"

cp "$tests/book_pages.mjs" "$work/"
CHROMIUM=$chromium exec node "$work/book_pages.mjs" "$2" "$work/book-screenshots"
