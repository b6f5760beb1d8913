// Types of the host's picture and depth with several samples per pixel.
alias HostColor = texture_multisampled_2d<f32>;
alias HostDepth = texture_multisampled_2d<f32>;
