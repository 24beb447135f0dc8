"""The glossary is sorted, defines each word once, and its links lead to files."""

import re

from workspaces import ROOT

PAGE = ROOT / 'docs' / 'glossary.md'
ROWS = re.findall(r'^\| (?!word |---)([^|]+) \| ([^|]+) \| ([^|]+) \|$', PAGE.read_text(), re.MULTILINE)


def test_the_words_are_sorted_and_defined_once():
    words = [word.lower() for word, _, _ in ROWS]
    assert words and words == sorted(set(words))


def test_each_word_leads_to_a_file_or_a_folder():
    for word, _, where in ROWS:
        links = re.findall(r'\]\(([^)]+)\)', where)
        assert links and all((PAGE.parent / link).exists() for link in links), word
