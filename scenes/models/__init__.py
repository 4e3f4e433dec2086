"""The places as models: solids, materials and lights, in numpy alone."""
