//! What a drawn world answers: the height of its ground, and whether its databases are loaded.

use crate::geodesy::Place;

/// The ground under a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terrain {
    /// Height in the datum of the altitudes that the host states, m.
    pub height_m: f64,
    /// Normal of the ground: azimuth from true north and elevation, degrees.
    pub normal_deg: [f64; 2],
    /// Material of the program's own list.
    pub material: u32,
}

/// State of a database that a host asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loading {
    /// It is still loading.
    Underway,
    /// It is ready.
    Ready,
    /// It cannot be loaded.
    Failed,
}

/// A world that is drawn, or stands in for one.
pub trait World {
    /// Returns the ground under a place, or `None` where there is none.
    fn terrain(&mut self, place: Place) -> Option<Terrain>;

    /// Begins to load a database, or goes on with it. Called once a frame until it is ready or has failed.
    fn load(&mut self, database: u8) -> Loading;
}

/// A world without ground, whose databases are those of a list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groundless {
    /// Databases that exist.
    pub databases: Vec<u8>,
}

impl World for Groundless {
    fn terrain(&mut self, _place: Place) -> Option<Terrain> {
        None
    }

    fn load(&mut self, database: u8) -> Loading {
        if self.databases.contains(&database) { Loading::Ready } else { Loading::Failed }
    }
}
