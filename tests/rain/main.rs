//! Rain as a host sees it, and what else falls and blows: where drops are drawn, what they cover, where it is dry. One
//! binary, so that it links once.

mod area_textures;
mod areas;
mod brute;
#[path = "../support/coarse_sky.rs"]
mod coarse_sky;
mod cones;
mod culled;
#[path = "../support/depth_texture.rs"]
mod depth_texture;
mod drops;
mod dry_places;
mod far;
mod integrated;
mod open_shares;
mod photometry;
mod pictures;
mod processes;
mod sand;
mod scene;
mod shapes;
mod shelter;
mod slopes;
mod speeds;
mod stability;
mod stereo;
mod stones;
mod streaks;
#[path = "../support/textures.rs"]
mod textures;
