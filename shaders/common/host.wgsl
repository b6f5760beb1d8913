// The host's picture and depth, of one sample a pixel. Variants of a shader read others in place of this file: `:multi`
// (host_multi.wgsl) and `:resolved` (host_resolved.wgsl).
alias HostColor = texture_2d<f32>;
alias HostDepth = texture_2d<f32>;
