//! Filters of planes of numbers, one direction at a time.

/// One number a pixel. Shape: `[height][width]`.
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f32>,
}

impl Plane {
    /// The plane filtered by `across` along its rows and by `down` along its columns. Shape of a kernel: odd, its
    /// middle at the pixel. Beyond its borders, a plane goes on as at its borders.
    pub(super) fn filtered(&self, across: &[f64], down: &[f64]) -> Self {
        self.filtered_across(across).filtered_down(down)
    }

    // Both add up whole rows, one weight after the other: each pixel's sum has the order of the kernel, and vector
    // instructions do several pixels at once.

    fn filtered_across(&self, kernel: &[f64]) -> Self {
        let radius = kernel.len() / 2;
        let mut filtered = Vec::with_capacity(self.values.len());
        let mut padded = vec![0.0; self.width + 2 * radius];
        let mut sums = vec![0.0; self.width];
        for row in self.rows() {
            padded[..radius].fill(f64::from(row[0]));
            padded[radius + self.width..].fill(f64::from(row[self.width - 1]));
            for (padded, &value) in padded[radius..].iter_mut().zip(row) {
                *padded = f64::from(value);
            }
            sums.fill(0.0);
            for (offset, weight) in kernel.iter().enumerate() {
                add(&mut sums, *weight, padded[offset..].iter().copied());
            }
            filtered.extend(sums.iter().map(|&sum| sum as f32));
        }
        Self { values: filtered, ..*self }
    }

    fn filtered_down(&self, kernel: &[f64]) -> Self {
        let radius = kernel.len() / 2;
        let rows = self.rows().collect::<Vec<_>>();
        let mut filtered = Vec::with_capacity(self.values.len());
        let mut sums = vec![0.0; self.width];
        for y in 0..self.height {
            sums.fill(0.0);
            for (offset, weight) in kernel.iter().enumerate() {
                let row = rows[(y + offset).saturating_sub(radius).min(self.height - 1)];
                add(&mut sums, *weight, row.iter().map(|&value| f64::from(value)));
            }
            filtered.extend(sums.iter().map(|&sum| sum as f32));
        }
        Self { values: filtered, ..*self }
    }

    fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.values.chunks_exact(self.width)
    }
}

fn add(sums: &mut [f64], weight: f64, values: impl Iterator<Item = f64>) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}
