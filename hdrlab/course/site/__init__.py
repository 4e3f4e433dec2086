"""The course as a site: executed notebooks, guides and the reference, in pages complete in themselves.

execute    runs notebooks, each once: what was run is kept by its content
live       takes the widgets out of a notebook, so that a page can open each of them with no kernel
formulas   draws formulas
reference  lays out a page for each module, and the map from the lecture to them
words      what the search takes for a word
lite       puts JupyterLite beside the pages, which runs the notebooks in a browser
boxes      puts boxes into pages in which a reader writes and checks a function
pages      puts all of it in one folder, and Sphinx with myst-nb makes the site of it

What is written by hand lies beside: `pages`, the guides in Markdown and the story in ten screens, and
`theme`, how a page looks.
"""
