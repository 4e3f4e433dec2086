"""The drawings and experiments of single lectures: what one notebook, or two, show and nothing else needs."""
