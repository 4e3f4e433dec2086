# %% [markdown]
# # Our own tasks
#
# Due {due}. {total} points. {late}
#
# In a task, use numpy and scipy; you cannot import hdrlab when your work is graded.

# %%
import numpy as np

from hdrlab.course.notebook import check, use_plan

use_plan("HOMEWORK")

# %% [markdown] about="TASK"
# ## Flat-field correction ({points})
#
# A lens gives the corners less light than the center, and no two pixels are alike. A photo of a
# white wall shows both: `flat` (H, W), pixel values above 0. Correct a photo $Z$ (H, W) of the same
# camera by
#
# $$\mathrm{corrected} = Z\,\frac{\operatorname{mean}(\mathrm{flat})}{\mathrm{flat}},$$
#
# where the mean is over all pixels. Pixel values are linear in the light. They may be integers or
# floats.

# %% task="TASK"
# Return Z mean(flat) / flat: as if every pixel got the same fraction of the light.

# %% about="TASK"
wall = np.linspace(120, 200, 8) * np.ones((4, 1))
TASK(wall, wall).round()
