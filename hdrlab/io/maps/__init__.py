"""The file formats of radiance maps, a format a file: RGBE, OpenEXR and its layers, PFM."""
