"""The prose of a file: its sentences, without code, addresses and markup.

Markdown, reStructuredText, and the strings of Python, launch files and shell scripts that programs print.
"""

import ast
import pathlib
import re
from typing import Callable, Dict, Iterator, List, NamedTuple, Tuple

Block = Tuple[int, str]  # the number of its first line, and its text

CODE = 'x'  # stands for a piece of code in a sentence: one word
LEAST_WORDS = 4  # a shorter string of a program is a name or a format rather than a sentence
ITEM = re.compile(r'^\s*(?:[-*+]|\d+\.)\s+')
END = re.compile(r'(?<=[.!?])(?<!e\.g\.)(?<!i\.e\.)["\')\]]*\s+(?=["\'(\[]*[A-Z0-9]|x\b)')


class Sentence(NamedTuple):
    """A sentence, and the number of the line in which its block begins."""

    line: int
    text: str

    @property
    def words(self) -> int:
        """How many words it has: what stands between spaces and has a letter or a digit."""
        return sum(bool(re.search(r'\w', word)) for word in self.text.split())


def sentences(path: pathlib.Path) -> List[Sentence]:
    """All sentences of a file, in order.

    Raises:
        KeyError: for a kind of file without prose.
    """
    blocks = KINDS[path.suffix](path.read_text(encoding='utf-8'))
    return [Sentence(line, part) for line, text in blocks for part in END.split(plain(text)) if part.strip()]


def plain(text: str) -> str:
    """A text without markup: a piece of code, or a list of them, is one word, and a link is what it shows."""
    text = re.sub(r'``.+?``|`[^`]+`(?:_+)?', CODE, text)
    text = re.sub(rf'\b{CODE}(?:, {CODE}\b)+', CODE, text)
    text = re.sub(r'!\[[^\]]*\]\([^)]*\)', '', text)
    text = re.sub(r'\[[^\]]*\w[/.]\w[^\]]*\]\([^)]*\)', CODE, text)  # the name of a file
    text = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', text)
    return re.sub(r'\*\*|(?<!\w)\*(?=\w)|(?<=\w)\*(?!\w)|<[^>]+>', '', ' '.join(text.split()))


def of_markdown(source: str) -> Iterator[Block]:
    """Paragraphs, headings, items of lists and cells of tables; no blocks of code."""
    return _paragraphs(_without_fences(source))


def of_restructured_text(source: str) -> Iterator[Block]:
    """Paragraphs and items of lists; no lines under headings."""
    return _paragraphs('' if re.match(r'[-=~^]{3,}$', line) else line for line in source.splitlines())


def of_python(source: str) -> Iterator[Block]:
    """Strings that read like prose, which programs print; no docstrings. What is filled in is one word."""
    tree = ast.parse(source)
    silent = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            silent |= {id(part) for each in ast.walk(node) for part in ast.iter_child_nodes(each)}
    for node in ast.walk(tree):
        text = _string(node) if isinstance(node, ast.expr) and id(node) not in silent else ''
        if len(text.split()) >= LEAST_WORDS and re.search('[a-z]{2} [a-z]{2}', text):
            yield from ((node.lineno, part) for part in text.splitlines())


def of_launch(source: str) -> Iterator[Block]:
    """What the arguments of a launch file mean."""
    for found in re.finditer(r'\bdoc="([^"]*)"', source):
        yield source.count('\n', 0, found.start()) + 1, found.group(1)


def of_shell(source: str) -> Iterator[Block]:
    """What `say` and `fail` print, and the page of help."""
    for found in re.finditer(r"""\b(?:say|fail \d) (?:'([^']*)'|"([^"]*)")""", source):
        yield source.count('\n', 0, found.start()) + 1, found.group(1) or found.group(2)
    for found in re.finditer(r"^usage\(\) \{\n *cat <<'END'\n(.*?)^END$", source, re.MULTILINE | re.DOTALL):
        start = source.count('\n', 0, found.start(1)) + 1
        yield from ((start + number, line) for number, line in enumerate(found.group(1).splitlines()))


KINDS: Dict[str, Callable[[str], Iterator[Block]]] = {
    '.md': of_markdown, '.rst': of_restructured_text, '.py': of_python, '.launch': of_launch, '': of_shell}


def _without_fences(source: str) -> Iterator[str]:
    """The lines of a page; those of a block of code are empty."""
    is_code = False
    for line in source.splitlines():
        fence = line.lstrip().startswith('```')
        yield '' if is_code or fence else line
        is_code ^= fence


def _paragraphs(lines: Iterator[str]) -> Iterator[Block]:
    """Lines that belong together, joined."""
    start, parts = 0, []  # type: Tuple[int, List[str]]
    for number, line in enumerate(lines, 1):
        alone = line.startswith(('|', '#'))
        if parts and (not line.strip() or alone or ITEM.match(line)):
            yield start, ' '.join(parts)
            parts = []
        if alone:
            yield from ((number, cell) for cell in line.strip('|#').split(' | '))
        elif line.strip():
            start = start if parts else number
            parts.append(ITEM.sub('', line, 1) if not parts else line)
    if parts:
        yield start, ' '.join(parts)


def _string(node: ast.expr) -> str:
    """The text of a string; nothing for other expressions."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return ''.join(part.value if isinstance(part, ast.Constant) else CODE for part in node.values)
    return ''
