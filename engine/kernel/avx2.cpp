/// Filled by the kernels.
