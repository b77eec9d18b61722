"""A Sphinx extension: formulas as MathML, which browsers draw without a script or a network. KaTeX of Debian translates."""

import html
import json
import os
import re
import subprocess

TRANSLATOR = """
const katex = require('katex');
require('readline').createInterface({input: process.stdin}).on('line', line => {
    const {tex, display} = JSON.parse(line);
    let answer;
    try { answer = {mathml: katex.renderToString(tex, {output: 'mathml', displayMode: display, throwOnError: true, strict: 'error'})}; }
    catch (error) { answer = {problem: error.message}; }
    process.stdout.write(JSON.stringify(answer) + '\\n');
});
"""


class Translator:
    """One process for all formulas."""

    def __init__(self):
        environment = {**os.environ, "NODE_PATH": "/usr/share/nodejs"}
        self.process = subprocess.Popen(["node", "-e", TRANSLATOR], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        env=environment)
        self.known = {}

    def mathml(self, tex, display):
        key = (tex, display)
        if key not in self.known:
            self.process.stdin.write(json.dumps({"tex": tex, "display": display}) + "\n")
            self.process.stdin.flush()
            answer = json.loads(self.process.stdout.readline())
            if "problem" in answer:
                raise ValueError(f"a formula is not understood: {answer['problem']}")
            self.known[key] = re.search(r"<math.*</math>", answer["mathml"], re.S).group(0)
        return self.known[key]


_translator = None


def _mathml(tex, display):
    global _translator
    _translator = _translator or Translator()
    return _translator.mathml(tex, display)


def visit_inline(self, node):
    self.body.append(_mathml(node.astext(), False))
    raise _skip()


def visit_display(self, node):
    """The number of an equation, \\tag{E1}, stands to its right."""
    tex = node.astext()
    number = re.search(r"\\tag\{([^}]*)\}", tex)
    tex = re.sub(r"\\tag\{[^}]*\}", "", tex)
    label = f'<span class="equation-number">({html.escape(number.group(1))})</span>' if number else ""
    self.body.append(f'<div class="equation"><div class="formula">{_mathml(tex, True)}</div>{label}</div>\n')
    raise _skip()


def _skip():
    from docutils import nodes

    return nodes.SkipNode()


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(visit_inline, None), block_renderers=(visit_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
