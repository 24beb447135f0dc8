"""Links of pages lead to files and headings that exist; every question has an answer; the index names every page."""

import functools
import re
import runpy
import types

import pytest
from workspaces import ROOT

QUESTIONS = ROOT / 'docs' / 'questions.md'
PAGES = [path for pattern in ('*.md', 'docs/*.md', 'rumba_*/README.md', 'rumba_tutorials/*/README.md')
         for path in sorted(ROOT.glob(pattern))]
LINK = re.compile(r'\]\(([^)\s]+)\)')
OF_PAGE = pytest.mark.parametrize('page', PAGES, ids=lambda path: str(path.relative_to(ROOT)))


def without_code(page):
    """The text of a page outside its blocks of code."""
    return re.sub('^```.*?^```$', '', page.read_text(), flags=re.MULTILINE | re.DOTALL)


@functools.lru_cache(maxsize=None)
def anchors(page):
    """The anchors of the headings of a page, as the hosts of repositories make them."""
    headings = re.findall('^#+ (.*)$', without_code(page), re.MULTILINE)
    return [re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings]


def broken(page):
    """The links of a page that lead nowhere."""
    for link in LINK.findall(without_code(page)):
        path, _, anchor = link.partition('#')
        target = (page.parent / path).resolve() if path else page
        if re.match('https?://', link):
            continue
        if not target.exists() or (anchor and anchor not in anchors(target)):
            yield link


@OF_PAGE
def test_links_lead_to_files_and_headings(page):
    assert list(broken(page)) == []


@pytest.mark.parametrize('page', sorted(ROOT.glob('docs/results_*.md')), ids=lambda path: path.name)
def test_each_table_of_results_has_its_commit(page):
    tables = re.findall(r'^```\n.*?^```\n(.*?\n.*\n)', page.read_text(), re.MULTILINE | re.DOTALL)
    assert [after for after in tables if not re.match(r'\nRecorded at [0-9a-f]{7,}\.\n', after)] == []


def test_every_question_has_an_answer():
    rows = [row for row in QUESTIONS.read_text().splitlines() if row.startswith('| ')]
    questions = [row for row in rows if row != '| question | answer |']
    assert len(questions) > 50
    assert [row for row in questions if not LINK.search(row.split(' | ')[-1])] == []


def test_the_page_leads_to_every_lesson():
    linked = set(re.findall(r'rumba_tutorials/(\w+)/README.md', QUESTIONS.read_text()))
    assert linked == {path.parent.name for path in ROOT.glob('rumba_tutorials/[0-9]*/README.md')}


def test_the_index_names_every_page():
    linked = {link for link in LINK.findall((ROOT / 'docs' / 'index.md').read_text()) if '/' not in link}
    assert linked == {path.name for path in ROOT.glob('docs/*.md')} - {'index.md'}


def test_the_sidebar_of_the_site_lists_every_page_and_lesson(tmp_path):
    site, application = runpy.run_path(str(ROOT / 'docs' / 'conf.py')), types.SimpleNamespace(srcdir=str(tmp_path))
    api = tmp_path / 'docs' / 'api'
    api.mkdir(parents=True)
    for name in ('rumba_sim.rst', 'rumba_sim.model.rst'):
        (api / name).touch()

    def listed(page):
        source = [(ROOT / f'{page}.md').read_text()]
        site['_add_contents'](application, page, source)
        return [line for block in re.findall(r'^```{toctree}\n(.*?)^```$', source[0], re.MULTILINE | re.DOTALL)
                for line in block.splitlines() if line and not line.startswith(':')]
    of_index = listed('docs/index')
    assert {f'docs/{name}.md' for name in of_index if '/' not in name} == {
        str(path.relative_to(ROOT)) for path in ROOT.glob('docs/*.md')} - {'docs/index.md'}
    assert len(of_index) == len(set(of_index)) and 'api/rumba_sim.model' not in of_index
    assert {'../README', '../rumba_tutorials/README', 'api/rumba_sim'} <= set(of_index)
    assert listed('rumba_tutorials/README') == [
        str(path.relative_to(ROOT / 'rumba_tutorials').with_suffix(''))
        for path in sorted(ROOT.glob('rumba_tutorials/[0-9]*/README.md'))]
