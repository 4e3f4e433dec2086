"""Make a radiance map of photos with a Python peer: PEER MAP.npy PHOTO...

The exposure times are those in EXIF. Each peer runs with its defaults.
"""

import sys

import numpy as np
from numpy.typing import NDArray
from PIL import ExifTags, Image

OPENCV_DEBEVEC = "opencv-debevec"
OPENCV_ROBERTSON = "opencv-robertson"
COLOUR_HDRI = "colour-hdri"
Float = NDArray[np.float32]
Levels = NDArray[np.uint8]


def main(peer: str, target: str, *photos: str) -> None:
    """Write the map as a NumPy file, red first."""
    images = [np.asarray(Image.open(photo)) for photo in photos]
    times = np.array([read_time(photo) for photo in photos], np.float32)
    merge = merge_with_colour_hdri if peer == COLOUR_HDRI else merge_with_opencv
    np.save(target, np.asarray(merge(peer, images, times), np.float32))


def read_time(photo: str) -> float:
    """Return the exposure time in seconds."""
    with Image.open(photo) as image:
        tags = image.getexif().get_ifd(ExifTags.IFD.Exif)
    return float(tags[ExifTags.Base.ExposureTime])


def merge_with_opencv(peer: str, images: list[Levels], times: Float) -> Float:
    """Calibrate and merge by Debevec's or by Robertson's method; OpenCV treats channels alike."""
    import cv2

    if peer == OPENCV_DEBEVEC:
        response = cv2.createCalibrateDebevec().process(images, times)
        return np.asarray(cv2.createMergeDebevec().process(images, times, response))
    response = cv2.createCalibrateRobertson().process(images, times)
    return np.asarray(cv2.createMergeRobertson().process(images, times, response))


def merge_with_colour_hdri(peer: str, images: list[Levels], times: Float) -> Float:
    """Calibrate and merge by Debevec's method; colour-hdri wants positive floats up to 1."""
    import colour_hdri

    stack = colour_hdri.ImageStack()
    for image, time in zip(images, times, strict=True):
        metadata = colour_hdri.Metadata(f_number=1, exposure_time=float(time), iso=100)
        stack.append(colour_hdri.Image(data=np.maximum(image, 1) / 255, metadata=metadata))
    curves = colour_hdri.camera_response_functions_Debevec1997(stack)
    E = colour_hdri.image_stack_to_HDRI(stack, camera_response_functions=curves)
    return np.asarray(E)


if __name__ == "__main__":
    main(*sys.argv[1:])
