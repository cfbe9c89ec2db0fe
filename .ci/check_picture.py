"""Checks that a picture that ParaView made shows a coloured sheet and not an empty view.

    python .ci/check_picture.py PICTURE.png
"""
import sys

import pyvista

LEAST = 0.05  # part of the picture that the sheet covers


def main():
    pixels = pyvista.read(sys.argv[1]).active_scalars[:, :3].astype(int)
    covered = (pixels.min(axis=1) < 250).mean()
    red = (pixels[:, 0] - pixels[:, 2] > 60).any()
    blue = (pixels[:, 2] - pixels[:, 0] > 60).any()
    assert covered > LEAST, f"the sheet covers {covered:.3f} of the picture"
    assert red and blue, "there are no mountains or no valleys"


main()
