"""The embedded scenes, whose radiance is known: three places rendered beforehand, and a room.

scenes.chapel(), scenes.workshop(), scenes.street()   radiance (H, W, 3) of a place
scenes.layers("street")                               its depth as well, and somebody to walk through it
scenes.compose(layers, (dy, dx))                      the place with that visitor, here or there
scenes.room(), scenes.decades(E)                      `hdrlab.scenes.computed.view`

How the places were made: `scenes.models`, and `python -m scenes.render`.
"""

from hdrlab.scenes.computed.view import decades, room
from hdrlab.scenes.places import PLACES, Layers, chapel, compose, layers, street, workshop

__all__ = ["PLACES", "Layers", "chapel", "compose", "decades", "layers", "room", "street", "workshop"]
