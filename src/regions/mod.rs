//! Weather regions: parts of the world with a weather of their own, such as a fog bank, a snow shower or a sandstorm.
//!
//! A region has a shape on the ground plan ([`RegionShape`]), a perimeter outside the shape over which the region's
//! weather fades into the weather around it, a velocity, and a whole [`Weather`](crate::weather::Weather) of which it
//! takes some parts ([`WeatherParts`](crate::weather::WeatherParts)). Regions are vertical columns: the weight does not
//! depend on height.
//!
//! # Weight
//! Let d be the horizontal distance from the shape, m, 0 inside, and P the perimeter. The weight of a region is its
//! strength times 1 - 3x^2 + 2x^3 with x = min(d / P, 1). The slope of the weight is at most 1.5 / P. With P = 0 the
//! weight is a step: it has its full value inside the shape and on the border.
//!
//! # Overlap
//! For each part of the weather, the world's weather and the regions have shares a_k whose sum is 1. Regions are taken
//! in the order in which the host lists them. A region of weight w that *covers* a part gets the share w, and all
//! earlier shares are multiplied by 1 - w. A region that *merges* a part joins the earlier regions that merge the same
//! part. All these regions together get the share 1 - (1 - m)(1 - w), where m is the sum of the shares that the earlier
//! merging regions have so far. They divide this share in proportion to their weights. All other shares are multiplied
//! by 1 - w. A region that covers the part also multiplies the weights of the earlier merging regions by 1 - w. Two
//! regions that merge and both have the weight 1 thus give the mean of their weathers. In a perimeter, a smaller weight
//! gives a smaller share. The shares are continuous in all weights.
//!
//! # Merging
//! A quantity x of a part is the sum of a_k x_k: extinction (not visibility), rates of precipitation, temperature,
//! humidity, pressure, wind (as a vector), cover of each cloud slot. The geometry of a layer is weighted by the amount
//! of the layer, as in a change over time ([`Conditions::lerp`](crate::weather::Conditions::lerp)). The total
//! extinction is the sum of the merged extinctions of air, aerosol, fog and precipitation. Rayleigh scattering and
//! ozone remain the world's.
//!
//! # Along a path
//! The optical depth between two points is the integral of the sum of a_k(s) e_k(s), where e_k is the extinction of the
//! medium k with its own heights. The path (`RegionWay`) is divided into pieces. Where all weights are constant, pieces
//! are long. In a perimeter a piece is at most P / 32 long, or longer if the weight changes by less than 1e-3 from the
//! middle of the piece to either end. At a border with P = 0 it is at most 1 mm long. Within a piece the shares are
//! those of its middle, and the optical depth of each medium has a closed form. The midpoint rule is of fourth order
//! for a whole perimeter, because the weight has no slope at the perimeter's edges. The error is below 1e-3 of the
//! optical depth in the perimeter (`tests/weather/regions.rs`).

mod field;
mod merge;
mod region;
mod seen;
mod shape;
mod way;

pub(crate) use field::RegionsOver;
pub(crate) use merge::RegionsHere;
pub(crate) use region::HeldRegion;
pub use region::{MAX_WEATHER_REGIONS, RegionPlan, WeatherRegion};
pub(crate) use seen::SeenRegion;
pub(crate) use shape::turns;
pub use shape::{MAX_REGION_CORNERS, RegionShape};
pub(crate) use way::RegionWay;
