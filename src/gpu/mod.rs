//! Devices, surfaces, targets, shader assembly, timing and readback.
