"""How Sphinx makes a site of these pages and of the docstrings: ./rumba docs."""

project = 'Rumba'
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.napoleon']
root_doc = 'docs/index'
html_title = 'Rumba'
html_theme = 'alabaster'
html_theme_options = {'description': 'a Roomba for ROS 1', 'page_width': '70em', 'fixed_sidebar': True}
myst_heading_anchors = 4  # links to headings
autodoc_mock_imports = ['distributed', 'gymnasium']  # optional
autodoc_default_options = {'members': True, 'show-inheritance': True}
