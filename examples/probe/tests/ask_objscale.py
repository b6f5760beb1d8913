"""Prints what the package objscale finds in pictures of 1024 x 1024 bytes: fractal dimension of single clouds, exponent
of perimeters, exponent of areas."""

import sys

import numpy
import objscale

masks = [numpy.fromfile(path, numpy.uint8).reshape(1024, 1024).astype(numpy.float32) for path in sys.argv[1:]]
found = [
    objscale.individual_fractal_dimension(masks),
    objscale.finite_array_powerlaw_exponent(masks, "summed perimeter"),
    objscale.finite_array_powerlaw_exponent(masks, "area"),
]
print(*found)
