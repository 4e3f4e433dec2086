"""Notebooks and assignments that run on the site itself, with nothing installed: JupyterLite.

wheels    packs hdrlab and the packages that it needs into wheels for the browser
checks    packs what the boxes "Try it" and the page for own photos load
in_browser, own_photos  answer them in the browser
build     runs JupyterLite, and keeps each edition of the notebooks in a folder of its own

`download` is an extension of JupyterLab that saves a student's notebook as a file; `settings.json`
holds JupyterLab's settings. `theme/static/lite.js` finds a student's work in her browser.
"""
