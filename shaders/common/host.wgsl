// Types of the host's picture and depth with one sample per pixel. Shader variants use other files in place of this
// one: `:multi` (host_multi.wgsl) and `:resolved` (host_resolved.wgsl).
alias HostColor = texture_2d<f32>;
alias HostDepth = texture_2d<f32>;
