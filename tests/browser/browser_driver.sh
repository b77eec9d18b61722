# The browser and its driver, for scripts that set `here` and `work`. To be sourced; ends the script with 77, ctest's
# "skipped", when the machine has no browser to open pages with. Sets `chromium`.
chromium=${CHROMIUM:-/usr/bin/chromium}
for tool in node npm "$chromium"; do
    if ! command -v "$tool" >/dev/null 2>&1; then
        echo "Skipped: '$tool' is missing, so no browser can open pages (Debian: apt-get install chromium nodejs npm)."
        exit 77
    fi
done

# npm works on a copy, and only when the lock file has changed: the source folder stays as it is. Scripts that run at the
# same time take turns.
mkdir -p "$work"
(
    flock 9
    if ! cmp -s "$here/package-lock.json" "$work/installed-lock.json"; then
        cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$work/"
        npm --prefix "$work" ci --ignore-scripts --loglevel=error
        cp "$here/package-lock.json" "$work/installed-lock.json"
    fi
    for script in "$here"/*.mjs; do
        cmp -s "$script" "$work/${script##*/}" || cp "$script" "$work/"
    done
) 9>"$work/driver.lock"
