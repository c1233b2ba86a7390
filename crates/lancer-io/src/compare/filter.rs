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
        let rows = self.convolved(across, |x, y, offset| {
            y * self.width + (x as isize + offset).clamp(0, self.width as isize - 1) as usize
        });
        rows.convolved(down, |x, y, offset| {
            (y as isize + offset).clamp(0, rows.height as isize - 1) as usize * rows.width + x
        })
    }

    fn convolved(&self, kernel: &[f64], neighbour: impl Fn(usize, usize, isize) -> usize) -> Self {
        let radius = (kernel.len() / 2) as isize;
        let mut values = Vec::with_capacity(self.values.len());
        for y in 0..self.height {
            for x in 0..self.width {
                let weighed = kernel
                    .iter()
                    .zip(-radius..)
                    .map(|(weight, offset)| weight * f64::from(self.values[neighbour(x, y, offset)]));
                values.push(weighed.sum::<f64>() as f32);
            }
        }
        Self { values, ..*self }
    }
}
