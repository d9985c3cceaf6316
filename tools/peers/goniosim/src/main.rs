//! Photons a second of eulumdat-goniosim in the box of tools/compare_photometry.py: `photon_rate PHOTONS` prints
//! seconds and the part of the flux that leaves.
use eulumdat_goniosim::*;
use nalgebra::{Point3, Unit, Vector3};

fn main() {
    let photons: u64 = std::env::args().nth(1).expect("PHOTONS").parse().expect("a number");
    let axis = |x: f64, y: f64, z: f64| Unit::new_unchecked(Vector3::new(x, y, z));
    let mut scene = Scene::new();
    scene.add_source(Source::AreaSource {
        center: Point3::new(0.0, 0.0, 0.001),
        normal: axis(0.0, 0.0, 1.0),
        u_axis: axis(1.0, 0.0, 0.0),
        half_width: 0.025,
        half_height: 0.025,
        flux_lm: 1000.0,
    });
    let white = scene.add_material(MaterialParams { reflectance_pct: 90.0, diffusion_pct: 100.0, ..catalog::white_paint() });
    // The floor, and four walls that look inwards; open above.
    let sides = [
        (Point3::new(0.0, 0.0, 0.0), axis(0.0, 0.0, 1.0), axis(1.0, 0.0, 0.0)),
        (Point3::new(-0.1, 0.0, 0.1), axis(1.0, 0.0, 0.0), axis(0.0, 1.0, 0.0)),
        (Point3::new(0.1, 0.0, 0.1), axis(-1.0, 0.0, 0.0), axis(0.0, 1.0, 0.0)),
        (Point3::new(0.0, -0.1, 0.1), axis(0.0, 1.0, 0.0), axis(1.0, 0.0, 0.0)),
        (Point3::new(0.0, 0.1, 0.1), axis(0.0, -1.0, 0.0), axis(1.0, 0.0, 0.0)),
    ];
    for (center, normal, u_axis) in sides {
        let sheet = Primitive::Sheet { center, normal, u_axis, half_width: 0.1, half_height: 0.1, thickness: 0.0 };
        scene.add_object(sheet, white, "wall");
    }
    let config = TracerConfig { num_photons: photons, max_bounces: 1000, ..TracerConfig::default() };
    let start = std::time::Instant::now();
    let result = Tracer::trace(&scene, &config);
    let seconds = start.elapsed().as_secs_f64();
    println!("{} {}", seconds, result.stats.total_energy_detected / result.stats.total_energy_emitted);
}
