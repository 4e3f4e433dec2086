"""From photographs and response to the radiance map of the scene."""
