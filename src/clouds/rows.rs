//! Maps about the camera of which a frame makes some rows anew, and all of them where nothing of the map holds any more.

/// How far a map has come.
#[derive(Default)]
pub(super) struct Rows {
    next: u32,
    /// Rows made since what the map is made of last changed: with all of them there is nothing left to do.
    made: u32,
}

impl Rows {
    /// The rows of `all` to make in a frame that makes `most`: the first of them and their number. `rests`: the map is made of the same as
    /// in the last frame; `holds`: of something near enough; `waits`: another map has its turn in this frame, if nothing is lost by it.
    pub fn due(&mut self, (all, most): (u32, u32), [rests, holds, waits]: [bool; 3]) -> Option<(u32, u32)> {
        if rests && self.made >= all {
            return None;
        }
        if waits && holds {
            self.made = if rests { self.made } else { 0 };
            return None;
        }
        let (first, rows) = if holds { (self.next, most.min(all - self.next)) } else { (0, all) };
        self.next = (first + rows) % all;
        self.made = if rests && holds { self.made + rows } else { rows };
        Some((first, rows))
    }
}

/// Draws these rows of a map by a full-screen pipeline, and leaves the others.
pub(super) fn draw(
    encoder: &mut wgpu::CommandEncoder,
    map: &wgpu::TextureView,
    (width, first, rows): (u32, u32, u32),
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
    pass.set_scissor_rect(0, first, width, rows);
    pass.set_pipeline(pipeline);
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_made_at_once_then_by_rows_and_rests_when_all_are_made() {
        let mut rows = Rows::default();
        assert_eq!(rows.due((8, 3), [false, false, false]), Some((0, 8)), "nothing holds");
        assert_eq!(rows.due((8, 3), [true, true, false]), None, "all made, and nothing changed");
        let changed: Vec<_> = (0..4).map(|_| rows.due((8, 3), [false, true, false])).collect();
        assert_eq!(changed, [Some((0, 3)), Some((3, 3)), Some((6, 2)), Some((0, 3))], "it changes on");
        let rests: Vec<_> = (0..3).map(|_| rows.due((8, 3), [true, true, false])).collect();
        assert_eq!(rests, [Some((3, 3)), Some((6, 2)), None], "at rest each row is made once more at most");
    }

    #[test]
    fn a_map_waits_for_another_and_forgets_no_change_meanwhile() {
        let mut rows = Rows::default();
        assert_eq!(rows.due((8, 4), [false, false, true]), Some((0, 8)), "what does not hold does not wait");
        assert_eq!(rows.due((8, 4), [false, true, true]), None, "it changes while it waits");
        let rests: Vec<_> = [false, true, false, true].map(|waits| rows.due((8, 4), [true, true, waits])).into();
        assert_eq!(rests, [Some((0, 4)), None, Some((4, 4)), None], "every row is made after the change");
        assert_eq!(rows.due((8, 4), [true, true, false]), None, "and then it rests");
    }
}
