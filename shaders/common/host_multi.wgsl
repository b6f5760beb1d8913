// The host's picture and depth, of several samples a pixel.
alias HostColor = texture_multisampled_2d<f32>;
alias HostDepth = texture_multisampled_2d<f32>;
