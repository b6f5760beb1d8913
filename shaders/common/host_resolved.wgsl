// Types of the host's resolved picture and of its depth with several samples per pixel, of which the first is used.
alias HostColor = texture_2d<f32>;
alias HostDepth = texture_multisampled_2d<f32>;
