//! What an image costs, learned from those before it.

use lancer_core::integrator::RayCounts;
use lancer_core::scene::Settings;

/// How long images take, per ray.
///
/// An image's time is taken to grow with its rays, and they with its pixels, subpixels and directions of ambient
/// occlusion. That is rough, and all that choosing a size needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost {
    /// Of a ray that is not of ambient occlusion, on all threads.
    seconds_per_ray: f64,
    /// Those that a subpixel takes besides ambient occlusion, itself included.
    rays_per_subpixel: f64,
    /// Rays of ambient occlusion that a subpixel takes for each direction asked for.
    ao_rays_per_direction: f64,
    /// Whether anything was measured.
    pub(super) is_measured: bool,
}

impl Cost {
    /// What a ray of ambient occlusion takes against another: they are short, and go in fans. Untuned.
    const AO_RAY: f64 = 0.25;

    /// The weight of the last image against those before: much, since the view has just moved, and not all, since
    /// some images are held up by other programs.
    const LAST: f64 = 0.6;

    /// How long an image takes, in seconds.
    pub(super) fn of(&self, settings: &Settings) -> f64 {
        let pixels = f64::from(settings.width) * f64::from(settings.height);
        let subpixels = f64::from(settings.samples * settings.samples);
        let ao_rays = self.ao_rays_per_direction * f64::from(settings.ao.samples);
        // One more for what the pixel shows.
        let rays = 1.0 + subpixels * (self.rays_per_subpixel + Self::AO_RAY * ao_rays);
        pixels * rays * self.seconds_per_ray
    }

    /// Learns from an image that took so many rays and so long.
    pub(super) fn learn(&mut self, settings: &Settings, rays: &RayCounts, seconds: f64) {
        let pixels = f64::from(settings.width) * f64::from(settings.height);
        let subpixels = (rays.primary as f64).max(1.0);
        let other = (rays.total() - rays.ao) as f64;
        let ao = rays.ao as f64;
        let last = if self.is_measured { Self::LAST } else { 1.0 };
        let learn = |known: &mut f64, found: f64| *known += last * (found - *known);
        learn(&mut self.seconds_per_ray, seconds / (pixels + other + Self::AO_RAY * ao).max(1.0));
        learn(&mut self.rays_per_subpixel, other / subpixels);
        if settings.ao.samples > 0 {
            learn(&mut self.ao_rays_per_direction, ao / subpixels / f64::from(settings.ao.samples));
        }
        self.is_measured = true;
    }
}

impl Default for Cost {
    /// Slow enough that the first image comes soon on any machine.
    fn default() -> Self {
        Self { seconds_per_ray: 2e-6, rays_per_subpixel: 5.0, ao_rays_per_direction: 1.0, is_measured: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::scene::AmbientOcclusion;

    fn settings(width: u32, samples: u32, ao: u32) -> Settings {
        let ao = AmbientOcclusion { samples: ao, distance: 1.0 };
        Settings { width, height: 100, samples, ao, ..Settings::default() }
    }

    /// The rays of an image with three rays a subpixel, and half of the directions above the horizon.
    fn rays(settings: &Settings) -> RayCounts {
        let primary = u64::from(settings.width * settings.height * settings.samples * settings.samples);
        let ao = primary * u64::from(settings.ao.samples) / 2;
        RayCounts { primary, shadow: primary, reflection: primary, ao, ..RayCounts::default() }
    }

    #[test]
    fn an_image_costs_what_it_cost_the_last_time() {
        for image in [settings(100, 1, 0), settings(30, 2, 16)] {
            let mut cost = Cost::default();
            cost.learn(&image, &rays(&image), 0.25);
            assert!((cost.of(&image) - 0.25).abs() < 1e-12);
        }
    }

    #[test]
    fn the_cost_of_large_images_follows_from_small_ones() {
        let seconds = |image: &Settings| {
            let rays = rays(image);
            let pixels = u64::from(image.width * image.height);
            1e-6 * ((pixels + rays.total() - rays.ao) as f64 + Cost::AO_RAY * rays.ao as f64)
        };
        let mut cost = Cost::default();
        let small = settings(20, 1, 4);
        cost.learn(&small, &rays(&small), seconds(&small));
        for large in [settings(400, 1, 0), settings(400, 4, 0), settings(400, 3, 64)] {
            let (found, expected) = (cost.of(&large), seconds(&large));
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} is not {expected}");
        }
    }

    #[test]
    fn more_pixels_subpixels_or_directions_never_cost_less() {
        let cost = Cost::default();
        let base = cost.of(&settings(100, 2, 8));
        for more in [settings(101, 2, 8), settings(100, 3, 8), settings(100, 2, 9)] {
            assert!(cost.of(&more) > base);
        }
    }
}
