"""What students are given: notebooks and handouts, and the stubs in them."""
