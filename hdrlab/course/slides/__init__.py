"""Decks of slides, made from the notebooks: one self-contained HTML file for each notebook.

rule      decides what is on each slide: text only, nothing is run
markdown  splits the text of a notebook into pieces that fit on slides
render    writes the slides of an executed notebook as HTML
decks     finds notebooks by name, runs them, and writes a deck for each

`deck.html`, `deck.css` and `deck.js` are the page around the slides. `reveal` holds reveal.js.
"""
