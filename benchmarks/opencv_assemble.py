"""What `hdrlab assemble` does, in OpenCV: PHOTOGRAPHS TIMES MAP --picture PICTURE."""

import csv
import sys
from pathlib import Path

import cv2
import numpy as np


def main(photographs: str, times: str, radiance: str, _: str, picture: str) -> None:
    """Read, align, calibrate, merge, tone-map, write."""
    with open(times, encoding="utf8", newline="") as file:
        listed = [(row["file"], float(row["exposure_time_s"])) for row in csv.DictReader(file)]
    images = [np.asarray(cv2.imread(str(Path(photographs) / name))) for name, _ in listed]
    seconds = np.array([second for _, second in listed], np.float32)
    cv2.createAlignMTB().process(images, images)
    response = cv2.createCalibrateDebevec().process(images, seconds)
    E = cv2.createMergeDebevec().process(images, seconds, response)
    cv2.imwrite(radiance, E)
    cv2.imwrite(picture, cv2.convertScaleAbs(cv2.createTonemapReinhard(2.2).process(E), alpha=255))


if __name__ == "__main__":
    main(*sys.argv[1:])
