//! Meshes for a tolerance.

use super::*;
use crate::rod::RodError;

#[test]
fn a_tolerance_finer_than_the_solvers_is_met() {
    let description = description(Kinematics::Kirchhoff, curved());
    let load = PointLoad {
        at: 0.8,
        wrench: Wrench::new(Vec3::new(0.05, -0.08, 0.06), Vec3::new(0.3, 0.2, -0.4)),
        frame: Frame::World,
    };
    let posed = |rod: Rod| -> Result<Problem, RodError> {
        let loads = NodalLoads::none(&rod).with_point(&rod, &load)?;
        Ok(Problem { loads, ..Problem::cantilever(rod) })
    };
    let precise = Settings { tolerance: 1e-13, ..Settings::default() };
    let rod = Rod::with_elements(description.clone(), 800, &[], Order::Fourth).unwrap();
    let exact = tip(&solved(&posed(rod).unwrap(), &precise));
    let mut worst = 0.0_f64;
    for loose in [1e-3, 1e-4, 1e-5] {
        let settings = Settings { tolerance: loose, ..Settings::default() };
        let tolerance = 1e-8;
        let refined = refine(&description, Order::Fourth, &[], tolerance, 100_000, &settings, posed).unwrap();
        assert!(refined.settings.tolerance <= 0.01 * tolerance);
        worst = worst.max(exact.between(&tip(&refined.solution)).log().max_abs());
    }
    assert!(worst <= 1e-8, "{worst:e}");
}
