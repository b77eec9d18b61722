"""The reference: what the program, the Python package and the headers say of themselves."""

import ast
import inspect
import re
import shutil
import sys
import textwrap


def write(book):
    book.write("reference/commands.md", commands(book))
    book.write("reference/configuration.md", configuration(book))
    book.write("reference/recording.md", "# Recording keys\n\n" + demoted(book.capstan("recording", "keys", "--format", "md")))
    book.write("reference/database.md", "# Database schema\n\n" + demoted(book.capstan("query", "--schema", "--format", "md")))
    book.write("reference/python.md", python(book))
    book.write("reference/cpp.md", headers(book))


def demoted(text):
    """Below the page's own title, one level of heading after the other."""
    lines, level, fenced = [], 1, False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        heading = None if fenced else re.match(r"(#+) (.*)", line)
        if heading:
            level = min(len(heading.group(1)) + 1, level + 1)
            level = max(level, 2)
            line = "#" * level + " " + heading.group(2)
        lines.append(line)
    return "\n".join(lines) + "\n"


def commands(book):
    """One section for each command, with its help."""
    listing = book.capstan("--help").split("Commands:\n")[1].split("\n\n")[0]
    names = [found.group(1) for found in re.finditer(r"^  (\S+(?: \S+)?)  ", listing, re.M)]
    names = [name for name in names if not name.startswith(("help", "--"))]
    text = "# Commands\n\nEach section is what `capstan help COMMAND` prints.\n\n"
    for name in names:
        text += f"## capstan {name}\n\n```text\n{book.capstan('help', *name.split())}```\n\n"
    return text


def configuration(book):
    """The complete configurations, cut at their sections."""
    text = "# Configuration keys\n\nEvery key with its default, as `capstan config default` prints them.\n"
    for title, words in (("Studies", []), ("Benches", ["--bench"])):
        text += f"\n## {title}\n\nFrom `{' '.join(['capstan config default', *words])}`.\n\n"
        part = []
        for line in book.capstan("config", "default", *words).splitlines():
            part.append(line)
        text += "```toml\n" + "\n".join(part) + "\n```\n"
    return text


def python(book):
    sys.path.insert(0, str(book.build / "python"))
    import capstan

    text = ("# Python\n\nEvery public name of the package `capstan`, from its docstrings. "
            "[The package at a glance](python-overview.md) says what belongs together.\n")
    for name in sorted(capstan.__all__, key=str.lower):
        thing = getattr(capstan, name)
        text += f"\n## {name}\n\n" + described(name, thing)
        if inspect.isclass(thing):
            for member, value in sorted(vars(thing).items()):
                function = value.fget if isinstance(value, property) else value
                if member.startswith("_") or not callable(function) or not function.__doc__:
                    continue
                text += f"\n### {name}.{member}\n\n" + described(member, value)
    return text


def described(name, thing):
    signature = _signature(name, thing)
    text = f"```python\n{signature}\n```\n\n" if signature else ""
    return text + _docstring(inspect.getdoc(thing) or "") + "\n"


def _signature(name, thing):
    """As the source has it, which names its types as a reader knows them."""
    if isinstance(thing, property):
        returns = _parsed(thing.fget).returns
        return f"{name}: {ast.unparse(returns)}"
    try:
        tree = _parsed(thing.__init__ if inspect.isclass(thing) else thing)
    except (TypeError, OSError, AttributeError, IndentationError):  # of a dataclass or a named tuple
        try:
            return f"{name}{inspect.signature(thing)}".replace(" -> None", "")
        except (TypeError, ValueError):
            return ""
    tree.args.args = [each for each in tree.args.args if each.arg != "self"]
    arguments = ast.unparse(tree.args)
    result = f" -> {ast.unparse(tree.returns)}" if not inspect.isclass(thing) else ""
    one_line = f"{name}({arguments}){result}"
    if len(one_line) < 90:
        return one_line
    return f"{name}(\n" + "".join(f"    {each},\n" for each in _split(arguments)) + f"){result}"


def _parsed(function):
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    if not isinstance(tree, ast.FunctionDef):
        raise TypeError
    return tree


def _split(arguments):
    """At commas outside of brackets."""
    depth, parts, part = 0, [], ""
    for letter in arguments:
        depth += letter in "[({"
        depth -= letter in "])}"
        if letter == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += letter
    return [*parts, part.strip()]


def _docstring(text):
    """Examples become blocks."""
    out, example = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith(">>>") or (example and line.strip()):
            example.append(line)
            continue
        if example:
            out += ["```pycon", *example, "```"]
            example = []
        out.append(line)
    return "\n".join(out)


def headers(book):
    """The reference that Doxygen wrote, within the book."""
    made = book.describe_headers()
    text = ("# C++ and C\n\n`find_package(capstan)` finds an installed library; each folder of headers is a component, linked as "
            "`capstan::solver`, for example. Programs that use it are in `tests/package/examples`.\n\n")
    if made is None:
        return text + "The reference of its headers is part of a book that is built where Doxygen is installed.\n"
    shutil.copytree(made, book.extra / "cpp", dirs_exist_ok=True)
    return text + ('```{raw} html\n<p><a href="../cpp/index.html">The reference of every header</a>, written by Doxygen.</p>\n```\n')
