//! Pages of the panel: which structs stand on which.

use welkin::capi::by_name::LISTS;

use crate::settings::{LAYERS, Part, Settings};

/// A page.
pub struct Page {
    /// Title.
    pub title: &'static str,
    /// Names of the parts that stand on it; the first element of a list stands for all of them.
    parts: &'static [Part],
}

/// Title of the page with the library's answers, which has nothing to set.
pub const ANSWERS: &str = "Answers";

/// All pages, in the order of the panel.
pub const PAGES: [Page; 12] = [
    Page { title: "Weather", parts: &[Part::Weather, Part::Overrides] },
    Page { title: "Clouds", parts: &[Part::Layer(0), Part::Call("wk_view_set_clouds")] },
    Page { title: "Sun", parts: &[Part::Call("wk_context_set_sun"), Part::Call("wk_context_set_moon")] },
    Page { title: "Sky", parts: &[Part::Call("wk_context_set_sky_settings"), Part::Call("wk_context_set_stars")] },
    Page {
        title: "Rain and snow",
        parts: &[
            Part::Call("wk_view_set_rain"),
            Part::Call("wk_view_set_snow"),
            Part::Call("wk_view_set_windscreen"),
            Part::Call("wk_context_set_lightning"),
        ],
    },
    Page { title: "Fog", parts: &[Part::Call("wk_context_set_fog_law")] },
    Page { title: "Wind", parts: &[Part::Call("wk_context_set_wind_field")] },
    Page {
        title: "Sea and ground",
        parts: &[Part::Call("wk_context_set_sea"), Part::Call("wk_context_set_terrain_drawing")],
    },
    Page { title: "Places", parts: &[Part::Item(0, 0), Part::Item(1, 0), Part::Item(2, 0), Part::Item(3, 0)] },
    Page { title: "Plan", parts: &[Part::Call("wk_view_set_budget")] },
    Page { title: "World", parts: &[Part::World] },
    Page { title: ANSWERS, parts: &[] },
];

impl Page {
    /// Parts on the page, with one more element of each list than there are.
    pub fn parts(&self, settings: &Settings) -> Vec<Part> {
        let layers = (settings.layers() + 1).min(LAYERS);
        let each = |part: &Part| match part {
            Part::Layer(_) => (0..layers).map(Part::Layer).collect(),
            Part::Item(list, _) => items(settings, *list),
            other => vec![*other],
        };
        self.parts.iter().flat_map(each).collect()
    }
}

/// Elements of a list, each with its weather, and one more.
fn items(settings: &Settings, list: usize) -> Vec<Part> {
    let count = settings.items(list);
    let weather = |i: usize| (i < count && LISTS[list].has_weather).then_some(Part::ItemWeather(list, i));
    (0..(count + 1).min(LISTS[list].most)).flat_map(|i| [Some(Part::Item(list, i)), weather(i)]).flatten().collect()
}

/// Title of a part on its page.
pub fn title(part: Part) -> String {
    match part {
        Part::World => "The host's world".into(),
        Part::Weather => "Weather".into(),
        Part::Overrides => "In place of what the weather gives".into(),
        Part::Layer(i) => format!("Cloud layer {}", i + 1),
        Part::ItemWeather(_, i) => format!("Weather of region {}", i + 1),
        Part::Call(_) | Part::Item(..) => {
            let key = part.key().replace('_', " ");
            let number = key.find(|c: char| c.is_ascii_digit()).unwrap_or(key.len());
            let key = format!("{} {}", &key[..number], &key[number..]).trim_end().to_owned();
            let mut letters = key.chars();
            letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
        }
    }
}
