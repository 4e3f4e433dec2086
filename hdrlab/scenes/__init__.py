"""The embedded scenes, whose radiance is known: four places, rendered before; and real photographs.

scenes.chapel(), workshop(), street(), room()         radiance (H, W, 3) of a place
scenes.layers("street")                               its depth as well, and somebody to walk through it
scenes.compose(layers, (dy, dx))                      the place with that visitor, here or there
scenes.window()                                       twelve real photos of a room, a bracket
scenes.photographs()                                  six real photos of a tripod, with wrong times
scenes.probe()                                        a studio from all directions, which lights what is in it
scenes.decades(E)                                     the range of a scene or of a map

How they were made: `scenes.models`, and `python -m scenes.render`; room and subjects:
`scenes.computed`.
"""

from hdrlab.core.extremes import decades
from hdrlab.scenes.places import PLACES, chapel, compose, layers, room, street, workshop
from hdrlab.scenes.real import photographs, probe, window

__all__ = ["PLACES", "chapel", "compose", "decades", "layers", "photographs", "probe", "room"]
__all__ += ["street", "window", "workshop"]
