"""A Sphinx extension: Debian's package of furo works from a file, without a web server.

Its style imports a sheet from a server's root and lost the rule for systems that prefer dark; its script imports another
one, which a browser refuses for files. The copies in the book are fixed; the package is not touched."""

import re
from pathlib import Path

SPY = "new Gumshoe("
WHERE_SECTIONS_ARE = """if (document.querySelector('.toc-tree a[href^="#"]:not([href="#"])')) """  # else it looks for the last of none


def fix(app, failed):
    if failed is not None or app.builder.format != "html":
        return
    static = Path(app.outdir) / "_static"
    style, script = static / "styles" / "furo.css", static / "scripts" / "furo.js"
    text = style.read_text()
    if text.startswith("@import url(/javascript/"):
        text = text.partition("\n")[2]
    if "prefers-color-scheme: dark" not in text:
        dark = re.search(r'body\[data-theme="dark"\] \{(.*?)\}', text, re.S).group(1)
        text += '\n@media screen and (prefers-color-scheme: dark) {\n  body:not([data-theme="light"]) {' + dark + "}\n}\n"
    style.write_text(text)
    text = script.read_text()
    if text.startswith("import Gumshoe"):
        script.write_text((static / "scripts" / "gumshoe-patched.js").read_text() + "\n(function () {\n"
                          + text.partition("\n")[2].replace(SPY, WHERE_SECTIONS_ARE + SPY) + "\n})();\n")


def setup(app):
    app.connect("build-finished", fix)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
