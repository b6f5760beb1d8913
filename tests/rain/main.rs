//! Rain, hail and blowing sand as a host sees them: where drops are drawn, how much they cover, where it is dry. One
//! binary, so that it links once.

mod area_textures;
mod areas;
mod cones;
mod culled;
mod drops;
mod dry_places;
mod far;
mod integrated;
mod open_shares;
mod photometry;
mod pictures;
mod processes;
mod sand;
mod shapes;
mod shelter;
mod slopes;
mod speeds;
mod stability;
mod stereo;
mod stones;
mod streaks;
