// The host's resolved picture, whose depth has several samples a pixel: the first stands for them.
alias HostColor = texture_2d<f32>;
alias HostDepth = texture_multisampled_2d<f32>;
