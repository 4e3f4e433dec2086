"""Configuration of a Jupyter server for hdrlab's notebooks.

The variable JUPYTER_CONFIG_PATH names the folder of this file. `hdrlab lab` sets it, and so do the
container image and Binder.
"""

from hdrlab.course import materials

config = get_config()  # type: ignore[name-defined]  # noqa: F821
config.LabServerApp.extra_labextensions_path = [str(materials.LAB_EXTENSIONS)]
page_config = {"hdrlabCodeDigests": materials.code_digests()}
config.ServerApp.tornado_settings = {"page_config_data": page_config}
