"""How Sphinx makes a site of these pages and of the docstrings: ./rumba docs."""

import pathlib
import re

project = 'Rumba'
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.napoleon']
root_doc = 'docs/index'
html_title = 'Rumba'
html_theme = 'furo'
html_search_scorer = str(pathlib.Path(__file__).with_name('search.js'))
html_show_sourcelink = False
html_static_path, html_css_files, html_js_files = ['site'], ['site.css'], ['site.js']
pygments_style, pygments_dark_style = 'xcode', 'rrt'  # those whose colours differ from their background by 4.5 to 1
highlight_language = 'none'  # what programs print is no Python
myst_heading_anchors = 4  # links to headings
autodoc_mock_imports = ['distributed', 'gymnasium']  # optional
autodoc_default_options = {'members': True, 'show-inheritance': True}

FIRST = 'index.html'  # for those who open the folder
SECTION = re.compile(r'^## (.+)$', re.MULTILINE)
ROW = re.compile(r'^\| (.*?) \|', re.MULTILINE)
LINK = re.compile(r'\]\((\S+?)\.md\)')


def setup(app):
    """Have Sphinx call what follows."""
    app.connect('source-read', _add_contents)
    app.connect('build-finished', _add_first_page)


def _add_contents(app, page, source):
    """Let the sidebar list what the first page and that of the lessons link to."""
    if page == root_doc:
        titles = SECTION.split(source[0])[1:]
        parts = [(title, LINK.findall(' '.join(ROW.findall(text)))) for title, text in zip(titles[::2], titles[1::2])]
        folder = pathlib.Path(app.srcdir, 'docs', 'api')
        api = sorted(f'api/{path.stem}' for path in folder.glob('*.rst') if '.' not in path.stem)
        source[0] += ''.join(map(_contents, ('Begin', *(title for title, _ in parts), 'Docstrings'),
                                 (['../README'], *(links for _, links in parts), api)))
    elif page == 'rumba_tutorials/README':
        source[0] += _contents('Lessons', list(dict.fromkeys(LINK.findall(' '.join(ROW.findall(source[0]))))))


def _contents(title, pages):
    """A list of contents that only the sidebar shows."""
    return '\n'.join(('', '', '```{toctree}', ':hidden:', f':caption: {title}', '', *pages, '```', ''))


def _add_first_page(app, error):
    """Let the folder of the site open with its first page."""
    if error is None and app.builder.name == 'html':
        target = f'{root_doc}.html'
        pathlib.Path(app.outdir, FIRST).write_text(
            f'<!DOCTYPE html><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={target}">'
            f'<title>Rumba</title><a href="{target}">Rumba</a>\n')
