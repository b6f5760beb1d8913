//! Masks of cloud and the clouds in them.

/// Square picture that says for each pixel whether there is cloud, rows from the south, pixels from the west.
#[derive(Clone, Debug)]
pub struct CloudMask {
    side: usize,
    cloudy: Vec<bool>,
}

/// One cloud of a mask.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cloud {
    /// Number of its pixels.
    pub pixels: usize,
    /// Number of edges between its pixels and clear ones, around its outside and its holes. Edges on the picture's
    /// border do not count.
    pub perimeter: usize,
    /// Whether it touches the picture's border.
    pub is_cut: bool,
}

impl CloudMask {
    /// Creates the mask of a picture with `side` x `side` pixels; `is_cloudy` takes column and row.
    pub fn new(side: usize, mut is_cloudy: impl FnMut(usize, usize) -> bool) -> Self {
        Self { side, cloudy: (0..side * side).map(|i| is_cloudy(i % side, i / side)).collect() }
    }

    /// Returns the number of pixels along a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Returns the pixels, row by row.
    pub fn pixels(&self) -> &[bool] {
        &self.cloudy
    }

    /// Returns the share of cloudy pixels.
    pub fn cover(&self) -> f64 {
        self.cloudy.iter().filter(|is_cloudy| **is_cloudy).count() as f64 / self.cloudy.len().max(1) as f64
    }

    /// Returns the pixels that touch pixel `i` along an edge.
    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> + use<> {
        let (side, x, y) = (self.side, i % self.side, i / self.side);
        let west = (x > 0).then(|| i - 1);
        let east = (x + 1 < side).then_some(i + 1);
        let south = (y > 0).then(|| i - side);
        let north = (y + 1 < side).then_some(i + side);
        [west, east, south, north].into_iter().flatten()
    }

    /// Returns whether a pixel lies at the picture's border.
    fn is_at_border(&self, i: usize) -> bool {
        self.neighbours(i).count() < 4
    }

    /// Numbers the connected sets of pixels with the value `cloudy` from 1; 0 for the other pixels. Returns the labels
    /// and the number of sets.
    fn labels(&self, cloudy: bool) -> (Vec<u32>, usize) {
        let mut labels = vec![0u32; self.cloudy.len()];
        let (mut count, mut open) = (0, Vec::new());
        for first in 0..labels.len() {
            if self.cloudy[first] != cloudy || labels[first] != 0 {
                continue;
            }
            count += 1;
            labels[first] = count;
            open.push(first);
            while let Some(i) = open.pop() {
                for j in self.neighbours(i) {
                    if self.cloudy[j] == cloudy && labels[j] == 0 {
                        labels[j] = count;
                        open.push(j);
                    }
                }
            }
        }
        (labels, count as usize)
    }

    /// Returns the mask of the clouds that are not cut, with their holes filled. A hole is a connected set of clear
    /// pixels other than the largest one.
    pub(super) fn whole_and_filled(&self) -> Self {
        let (clouds, labels) = clouds_of(self);
        let is_whole = |label: u32| label > 0 && !clouds[label as usize - 1].is_cut;
        let whole = Self { side: self.side, cloudy: labels.iter().map(|label| is_whole(*label)).collect() };
        let (clear, count) = whole.labels(false);
        let mut sizes = vec![0usize; count + 1];
        clear.iter().for_each(|label| sizes[*label as usize] += 1);
        let outside = (1..=count).max_by_key(|label| sizes[*label]).unwrap_or(0);
        Self { side: self.side, cloudy: clear.iter().map(|label| *label as usize != outside).collect() }
    }
}

/// Returns the clouds of a mask, and for each pixel the number of its cloud, counted from 1; 0 for clear pixels.
pub fn clouds_of(mask: &CloudMask) -> (Vec<Cloud>, Vec<u32>) {
    let (labels, count) = mask.labels(true);
    let mut clouds = vec![Cloud::default(); count];
    for (i, label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let cloud = &mut clouds[*label as usize - 1];
        cloud.pixels += 1;
        cloud.perimeter += mask.neighbours(i).filter(|j| !mask.cloudy[*j]).count();
        cloud.is_cut |= mask.is_at_border(i);
    }
    (clouds, labels)
}
