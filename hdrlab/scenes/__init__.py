"""The embedded scenes, whose radiance is known: three places rendered before, and a room; real photographs.

scenes.chapel(), scenes.workshop(), scenes.street()   radiance (H, W, 3) of a place
scenes.layers("street")                               its depth as well, and somebody to walk through it
scenes.compose(layers, (dy, dx))                      the place with that visitor, here or there
scenes.photographs()                                  six real photographs, a bracket
scenes.room(), scenes.decades(E)                      `hdrlab.scenes.computed.view`

How the places were made: `scenes.models`, and `python -m scenes.render`.
"""

from hdrlab.scenes.computed.view import decades, room
from hdrlab.scenes.places import PLACES, chapel, compose, layers, street, workshop
from hdrlab.scenes.real import photographs

__all__ = ["PLACES", "chapel", "compose", "decades", "layers", "photographs", "room", "street", "workshop"]
