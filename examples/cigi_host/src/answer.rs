//! Answers to requests about a place: the environment from what the host has said, heights from the world.

use crate::geodesy::Place;
use crate::notes::{Checked, Notes};
use crate::state::State;
use crate::wire::{
    AerosolConcentrationResponse, EnvironmentalConditionsRequest, HatHotExtendedResponse, HatHotRequest,
    HatHotResponse, MaritimeSurfaceConditionsResponse, Packet, TerrestrialSurfaceConditionsResponse,
    WeatherConditionsResponse,
};
use crate::world::World;

const MARITIME: u8 = 1;
const TERRESTRIAL: u8 = 2;
const WEATHER: u8 = 4;
const AEROSOL: u8 = 8;
/// Temperature of a sea of which the host has said nothing, degrees Celsius: at least that at which it freezes.
const FREEZING_SEA_C: f64 = -1.8;

/// Returns the nearest place with a latitude, a longitude and an altitude in their ranges; `None` if one is not finite.
fn on_earth(place: Place, packet: &'static str, notes: &mut Notes) -> Option<Place> {
    let Place { latitude_deg, longitude_deg, altitude_m } = place;
    if ![latitude_deg, longitude_deg, altitude_m].iter().all(|v| v.is_finite()) {
        notes.add(packet, "", "its place is not finite");
        return None;
    }
    let mut checked = Checked { notes, packet };
    Some(Place {
        latitude_deg: checked.number("latitude_deg", latitude_deg, 0.0, [-90.0, 90.0]),
        longitude_deg: checked.number("longitude_deg", longitude_deg, 0.0, [-360.0, 360.0]),
        altitude_m: checked.number("altitude_m", altitude_m, 0.0, [-1e7, 1e9]),
    })
}

/// Returns the answers to a request: sea, ground, weather, particles, as far as it asks for them. `geoid_height_m` is
/// how high mean sea level lies above the datum of the request's altitude.
pub fn environment(
    request: &EnvironmentalConditionsRequest,
    state: &State,
    geoid_height_m: f64,
    notes: &mut Notes,
) -> Vec<Packet> {
    let EnvironmentalConditionsRequest { request_id, latitude_deg, longitude_deg, altitude_m, .. } = *request;
    let stated = Place { latitude_deg, longitude_deg, altitude_m };
    let Some(place) = on_earth(stated, EnvironmentalConditionsRequest::LAYOUT.name, notes) else { return Vec::new() };
    let place = Place { altitude_m: place.altitude_m - geoid_height_m, ..place };
    let asks = |bit: u8| request.request_type_bits & bit != 0;
    let mut answers: Vec<Packet> = Vec::new();
    let air = if asks(WEATHER) || asks(MARITIME) { state.air_at(place) } else { state.atmosphere };
    if asks(MARITIME) {
        let sea = state.sea_at(place);
        let value = |own: fn(&crate::state::Sea) -> f64, other: f64| sea.as_ref().map_or(other, own) as f32;
        answers.push(
            MaritimeSurfaceConditionsResponse {
                request_id,
                sea_surface_height_m: value(|sea| sea.surface_height_m, 0.0),
                water_temperature_c: value(|sea| sea.temperature_c, air.temperature_c.max(FREEZING_SEA_C)),
                clarity_percent: value(|sea| sea.clarity_percent, 100.0),
            }
            .into(),
        );
    }
    if asks(TERRESTRIAL) {
        let conditions = state.ground_at(place);
        let dry = conditions.is_empty().then_some(0);
        let ids = conditions.into_iter().chain(dry).map(u32::from);
        answers.extend(ids.map(|surface_condition_id| {
            Packet::from(TerrestrialSurfaceConditionsResponse { request_id, surface_condition_id })
        }));
    }
    if asks(WEATHER) {
        answers.push(
            WeatherConditionsResponse {
                request_id,
                humidity_percent: air.humidity_percent.round() as u8,
                air_temperature_c: air.temperature_c as f32,
                visibility_m: air.visibility_m as f32,
                horizontal_wind_mps: air.wind_mps as f32,
                vertical_wind_mps: air.vertical_wind_mps as f32,
                wind_from_deg: air.wind_from_deg as f32,
                pressure_hpa: air.pressure_hpa as f32,
            }
            .into(),
        );
    }
    if asks(AEROSOL) {
        answers.extend(state.aerosols_at(place).into_iter().map(|aerosol| {
            let (layer_id, aerosol_g_m3) = (aerosol.layer_id, aerosol.g_m3 as f32);
            Packet::from(AerosolConcentrationResponse { request_id, layer_id, aerosol_g_m3 })
        }));
    }
    answers
}

/// Returns the answer to a request for a height. Without ground there the answer says that it is not valid, and is
/// counted.
pub fn height(
    request: &HatHotRequest,
    state: &State,
    host_frame_number: u32,
    world: &mut dyn World,
    notes: &mut Notes,
) -> Packet {
    const NAME: &str = HatHotRequest::LAYOUT.name;
    let place = if request.coordinate_system == 0 {
        let HatHotRequest { latitude_deg, longitude_deg, altitude_m, .. } = *request;
        Some(Place { latitude_deg, longitude_deg, altitude_m })
    } else {
        let offset = [request.x_offset_m, request.y_offset_m, request.z_offset_m];
        state.entity_pose(request.entity_id).map(|pose| pose.with_child(offset, [0.0; 3]).place)
    };
    let place = place.and_then(|place| on_earth(place, NAME, notes));
    if place.is_none() {
        notes.add(NAME, "", "answered as not valid, its place is not known");
    }
    let terrain = place.and_then(|place| Some((place, world.terrain(place)?)));
    if place.is_some() && terrain.is_none() {
        notes.add(NAME, "", "answered as not valid, there is no ground in this world");
    }
    let (hot_m, hat_m) =
        terrain.map_or((0.0, 0.0), |(place, ground)| (ground.height_m, place.altitude_m - ground.height_m));
    let (hat_hot_id, valid, host_frame_number_lsn) =
        (request.hat_hot_id, terrain.is_some(), (host_frame_number & 15) as u8);
    match request.request_type {
        0 | 1 => {
            let (response_type, height_m) = if request.request_type == 0 { (0, hat_m) } else { (1, hot_m) };
            HatHotResponse { hat_hot_id, valid, response_type, host_frame_number_lsn, height_m }.into()
        }
        _ => {
            let ground = terrain.map(|(_, ground)| ground);
            let [azimuth, elevation] = ground.map_or([0.0; 2], |ground| ground.normal_deg);
            HatHotExtendedResponse {
                hat_hot_id,
                valid,
                host_frame_number_lsn,
                hat_m,
                hot_m,
                material_code: ground.map_or(0, |ground| ground.material),
                normal_azimuth_deg: azimuth as f32,
                normal_elevation_deg: elevation as f32,
            }
            .into()
        }
    }
}
