//! Choice of the rows that a frame refreshes in a map of clouds around the camera (shadow map, panorama): some rows
//! once enough have become old, or all rows if the whole map is out of date.

/// Progress of a map's refresh.
#[derive(Default)]
pub(crate) struct MapRows {
    /// Index of the row to refresh next.
    next: u32,
    /// Rows refreshed since the map's inputs last changed. Once this is the number of all rows, there is nothing left
    /// to do.
    made: u32,
    /// Number of rows that have become old, estimated from the changes of the inputs. While the inputs change, a map
    /// that is kept ([`Turn::holds`]) and is not coarse waits until this number reaches the number of rows that one
    /// frame refreshes.
    owed: f64,
    /// Whether the last frame refreshed some rows.
    made_some: bool,
}

/// State of a map in a frame, from which the rows to refresh follow.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    /// Whether the map's inputs are those of the last frame.
    pub rests: bool,
    /// Whether the map's content is close enough to the current inputs to be kept.
    pub holds: bool,
    /// Share of the map that has become old by the change since the last frame.
    pub aged: f64,
    /// Whether another map is refreshed in this frame, so that this one waits if it can.
    pub waits: bool,
    /// Whether the map is still coarse. However few of its rows are old, every frame then refreshes some, unless the
    /// map waits for another one.
    pub is_coarse: bool,
}

impl MapRows {
    /// Returns the rows to refresh in a frame: the first one and their number. They are at most `most` of `all` rows,
    /// or all rows if the map's content cannot be kept ([`Turn::holds`]).
    pub fn due(&mut self, (all, most): (u32, u32), turn: &Turn) -> Option<(u32, u32)> {
        let first_again = std::mem::take(&mut self.made_some);
        if turn.rests && self.made >= all {
            return None;
        }
        self.made = if turn.rests { self.made } else { 0 };
        self.owed = (self.owed + f64::from(all) * turn.aged).min(f64::from(all));
        // While nothing changes, every second frame refreshes some rows, until all are up to date.
        let early = if turn.rests { first_again } else { self.owed < f64::from(most) };
        if turn.holds && (turn.waits || early && !turn.is_coarse) {
            return None;
        }
        let (first, rows) = if turn.holds { (self.next, most.min(all - self.next)) } else { (0, all) };
        self.next = (first + rows) % all;
        self.made += rows;
        self.owed = (self.owed - f64::from(rows)).max(0.0);
        self.made_some = true;
        Some((first, rows))
    }
}

/// Rows of a map that is `width` texels wide.
#[derive(Clone, Copy)]
pub(crate) struct RowSpan {
    /// Width of the map, texels.
    pub width: u32,
    /// Index of the first row.
    pub first: u32,
    /// Number of rows.
    pub count: u32,
}

/// Draws these rows of a map with a full-screen pipeline; the other rows stay.
pub(crate) fn draw(
    encoder: &mut wgpu::CommandEncoder,
    map: &wgpu::TextureView,
    RowSpan { width, first, count }: RowSpan,
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("rows of clouds"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: map,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_scissor_rect(0, first, width, count);
    pass.set_pipeline(pipeline);
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAP: Turn = Turn { rests: false, holds: false, aged: 0.0, waits: false, is_coarse: false };
    const MOVES: Turn = Turn { holds: true, aged: 0.125, ..LEAP };
    const RESTS: Turn = Turn { rests: true, holds: true, ..LEAP };

    #[test]
    fn a_map_is_drawn_at_once_then_as_its_rows_grow_old_and_rests_when_all_are_new() {
        let mut rows = MapRows::default();
        assert_eq!(rows.due((8, 3), &LEAP), Some((0, 8)), "nothing holds");
        assert_eq!(rows.due((8, 3), &RESTS), None, "all made, and nothing changed");
        let moves: Vec<_> = (0..10).filter_map(|i| rows.due((8, 3), &MOVES).map(|rows| (i, rows))).collect();
        assert_eq!(moves, [(2, (0, 3)), (5, (3, 3)), (8, (6, 2))], "a row a frame grows old");
        let rests: Vec<_> = (0..7).map(|_| rows.due((8, 3), &RESTS)).collect();
        let made = [Some((0, 3)), None, Some((3, 3)), None, Some((6, 2)), None, None];
        assert_eq!(rests, made, "at rest each row is made once more, in every second frame");
    }

    #[test]
    fn a_map_that_waits_for_another_still_redraws_every_row_after_a_change() {
        let mut rows = MapRows::default();
        let waits = |turn: Turn, waits| Turn { waits, ..turn };
        assert_eq!(rows.due((8, 4), &waits(LEAP, true)), Some((0, 8)), "what does not hold does not wait");
        let old = Turn { aged: 0.5, ..MOVES };
        assert_eq!(rows.due((8, 4), &waits(old, true)), None, "it changes while it waits");
        let turns = [false, true, false, true].map(|w| rows.due((8, 4), &waits(RESTS, w)));
        assert_eq!(turns, [Some((0, 4)), None, Some((4, 4)), None], "every row is made after the change");
        assert_eq!(rows.due((8, 4), &RESTS), None, "and then it rests");
    }

    #[test]
    fn the_rows_of_a_coarse_map_are_redrawn_at_once() {
        let mut rows = MapRows::default();
        let coarse = Turn { aged: 0.0, is_coarse: true, ..MOVES };
        assert_eq!([(); 2].map(|()| rows.due((8, 4), &coarse)), [Some((0, 4)), Some((4, 4))]);
    }
}
