"""The check of the prose finds what style forbids, in each kind of file, and nothing else."""

import pathlib

import pytest

from prose import __main__ as command
from prose import rules, texts

LONG = ' '.join(['word'] * (rules.MOST_WORDS + 1))


def read(tmp_path, name, source):
    """The sentences of a file with this text: line and text."""
    path = tmp_path / name
    path.write_text(source)
    return [tuple(sentence) for sentence in texts.sentences(path)]


def faults(text):
    """What is wrong with a sentence."""
    return [fault.text for fault in rules.faults([texts.Sentence(7, text)])]


def test_sentences_of_a_page_are_without_code_links_and_markup(tmp_path):
    page = ('# A title\n\n**See** [the page](other.md) first. **Goal.** Then **run**\n`./rumba run` now.\n\n'
            '```sh\nno prose\n```\n- an item\n- two')
    assert read(tmp_path, 'page.md', page) == [
        (1, 'A title'), (3, 'See the page first.'), (3, 'Goal.'),
        (3, 'Then run x now.'), (9, 'an item'), (10, 'two')]


def test_cells_of_a_table_are_sentences_of_their_own(tmp_path):
    assert read(tmp_path, 'page.md', '| one cell | `code` and words |\n') == [(1, 'one cell'), (1, 'x and words')]
    assert read(tmp_path, 'page.md', 'Names: `a`, `b`, `c`; then more.\n') == [(1, 'Names: x; then more.')]


def test_numbers_and_abbreviations_do_not_end_a_sentence(tmp_path):
    assert len(read(tmp_path, 'page.md', 'It takes 2.5 s, e.g. On Debian. 3 more follow.\n')) == 2


def test_items_of_a_changelog_are_without_their_headings_lines(tmp_path):
    assert read(tmp_path, 'CHANGELOG.rst', 'Forthcoming\n-----------\n* Add ``this``\n  and that.\n') == [
        (1, 'Forthcoming'), (3, 'Add x and that.')]


def test_strings_of_a_program_count_but_not_its_docstrings_and_names(tmp_path):
    source = '"""This module is not printed."""\nraise E(f"{name} is not a good name: {why}")\na = "some_name"\n'
    assert read(tmp_path, 'module.py', source) == [(2, 'x is not a good name: x')]


def test_the_meaning_of_arguments_and_what_a_script_says(tmp_path):
    launch = '<launch>\n<arg name="n" doc="What it does." /></launch>'
    assert read(tmp_path, 'a.launch', launch) == [(2, 'What it does.')]
    script = "usage() {\n    cat <<'END'\nUsage: it\nEND\n}\nfail 2 \"no such file\"\n"
    assert sorted(read(tmp_path, 'script', script)) == [(3, 'Usage: it'), (6, 'no such file')]


@pytest.mark.parametrize('text', [
    'What a plan beside obstacles visits is what the brush can reach.', 'It knows its pose, as no real robot knows it.',
    'The node has them told by x.', 'The end of the plan of a mate.', 'This is by what robots know where they are.',
    'A robot believes to be elsewhere.', 'What the nodes bear.', 'What is swept stays.', 'A node of yours.'])
def test_turns_of_the_past_are_found(text):
    assert faults(text)


@pytest.mark.parametrize('text', [
    'When obstacles are known, a plan covers only floor that the brush can reach.',
    'The node x exchanges these reports through x.', 'What is it? It is a robot.', 'The estimate is material.'])
def test_plain_sentences_pass(text):
    assert faults(text) == []


def test_a_long_sentence_is_found_and_one_word_less_passes():
    assert len(faults(LONG)) == 1 and faults(LONG.split(' ', 1)[1]) == []


def test_a_long_page_is_found():
    page = [texts.Sentence(1, 'two words')] * 3
    assert list(rules.fault_of_length(page, 6)) == []
    assert len(list(rules.fault_of_length(page, 5))) == 1


def test_faults_are_printed_with_their_file_and_line_and_fail(tmp_path, monkeypatch, capsys):
    (tmp_path / 'README.md').write_text('One line.\n\nSentences are short, are they not, until ' + 25 * 'word ' + '.\n')
    monkeypatch.setattr(command, 'ROOT', tmp_path)
    assert command.main() == 1
    assert capsys.readouterr().out.startswith('README.md:3: ')
    (tmp_path / 'README.md').write_text('One line.\n')
    assert command.main() == 0 and capsys.readouterr().out == ''


def test_it_reads_pages_changelogs_programs_and_launch_files():
    kinds = {(path.suffix, path.name if path.suffix == '.rst' else '') for path in command.files()}
    assert kinds == {('.md', ''), ('.rst', 'CHANGELOG.rst'), ('.py', ''), ('.launch', ''), ('', '')}
    assert pathlib.Path(command.ROOT, 'README.md') in command.files()
