//! Plates and bodies whose light is known in closed form.

use base::{Budget, CancelToken, Run, Seed};
use glam::DVec3;
use light::{Absorption, Beams, LightError, LightSpec, LitScene, Optics, SkyKind, SunPosition, absorb};

use crate::scenes::{add_square, ball};

const CELL: f64 = 2.0;

/// Plates that fill the cell, from the lowest up.
fn plates(optics: &[Optics]) -> LitScene {
    let mut scene = LitScene { receivers: optics.to_vec(), ..LitScene::default() };
    for k in 0..u32::try_from(optics.len()).expect("few") {
        let middle = DVec3::new(1.0, 0.5 * f64::from(k + 1), 1.0);
        add_square(&mut scene, middle, DVec3::Y, CELL, k);
    }
    scene
}

fn repeated(bounces: u32, soil_reflectance: f64) -> LightSpec {
    LightSpec { lines: 4_000, bounces, soil_reflectance, repeat_m: Some([CELL; 2]), ..LightSpec::default() }
}

fn lit(scene: &LitScene, beams: &Beams, spec: &LightSpec) -> Absorption {
    absorb(scene, beams, spec, Seed::new(3), &Run::plain()).expect("a result")
}

fn sun(elevation_deg: f64) -> Beams {
    let mut beams = Beams::default();
    beams.add_sun(SunPosition { azimuth_deg: 77.0, elevation_deg }, 100.0).expect("a sun");
    beams
}

fn all_of(balance: light::EnergyBalance) -> f64 {
    balance.absorbed_w + balance.soil_w + balance.reflected_w + balance.lost_w
}

#[test]
fn light_between_two_plates_sums_up_as_the_adding_method_says() {
    let leaf = Optics { reflectance: 0.4, transmittance: 0.3 };
    let scene = plates(&[leaf, leaf]);
    let (r, t, area) = (leaf.reflectance, leaf.transmittance, CELL * CELL);
    for beams in [sun(30.0), Beams::sky(SkyKind::Overcast, 100.0).expect("a sky")] {
        let found = lit(&scene, &beams, &repeated(50, 0.0));
        // Down and up between the plates: d = t + r u, u = r d.
        let down = t / (1.0 - r * r);
        let up = r * down;
        let lower = 100.0 * area * down * (1.0 - r - t);
        let upper = 100.0 * area * (1.0 + up) * (1.0 - r - t);
        assert!(
            (found.receivers[0].absorbed_w / lower - 1.0).abs() < 1e-5,
            "{:?}, not {lower}",
            found.receivers[0]
        );
        assert!(
            (found.receivers[1].absorbed_w / upper - 1.0).abs() < 1e-5,
            "{:?}, not {upper}",
            found.receivers[1]
        );
        let balance = found.balance.expect("a balance");
        assert!((balance.soil_w / (100.0 * area * down * t) - 1.0).abs() < 1e-5, "{balance:?}");
        assert!((balance.reflected_w / (100.0 * area * (r + t * up)) - 1.0).abs() < 1e-5, "{balance:?}");
    }
}

#[test]
fn one_bounce_between_plate_and_soil_is_followed_exactly() {
    let leaf = Optics { reflectance: 0.2, transmittance: 0.5 };
    let scene = plates(&[leaf]);
    let found = lit(&scene, &sun(60.0), &repeated(40, 0.3));
    let (r, t, soil) = (0.2, 0.5, 0.3);
    // On the soil: t + r * soil * on the soil.
    let ground = 100.0 * CELL * CELL * t / (1.0 - r * soil);
    let balance = found.balance.expect("a balance");
    assert!((balance.soil_w / (ground * (1.0 - soil)) - 1.0).abs() < 1e-5, "{balance:?}");
    let on_plate = 100.0 * CELL * CELL + soil * ground;
    assert!((found.receivers[0].absorbed_w / (on_plate * (1.0 - r - t)) - 1.0).abs() < 1e-5);
}

#[test]
fn energy_is_kept_with_few_and_many_bounces() {
    let scene = plates(&[Optics::LEAF, Optics { reflectance: 0.5, transmittance: 0.45 }, Optics::WOOD]);
    for bounces in [0, 1, 2, 5, 50] {
        let balance = lit(&scene, &sun(25.0), &repeated(bounces, 0.2)).balance.expect("a balance");
        assert!((all_of(balance) / balance.incoming_w - 1.0).abs() < 1e-9, "{bounces}: {balance:?}");
        assert_eq!(balance.lost_w > 0.01 * balance.incoming_w, bounces == 0, "{bounces}: {balance:?}");
    }
}

#[test]
fn a_ball_absorbs_the_beam_that_its_outline_cuts_out() {
    let radius = 0.7;
    let scene = ball(DVec3::new(0.3, 2.0, -1.0), radius, 48);
    let spec = LightSpec { lines: 100_000, soil_reflectance: 0.0, ..LightSpec::default() };
    for elevation in [10.0_f64, 45.0, 90.0] {
        let found = lit(&scene, &sun(elevation), &spec);
        let beam = 100.0 / base::ops::sin(elevation.to_radians());
        let outline = base::ops::PI * radius * radius;
        assert!(
            (found.receivers[0].absorbed_w / (beam * outline) - 1.0).abs() < 0.003,
            "{elevation}: {found:?}"
        );
        // Half of it is in the sun, the other half in its own shadow.
        assert!((found.receivers[0].sunlit.expect("a sun") - 0.5).abs() < 0.01);
    }
    // In a uniform sky of radiance L and its half sphere of directions: pi r^2 times 2 pi L, where a plane gets pi L.
    let found = lit(&scene, &Beams::sky(SkyKind::Uniform, 100.0).expect("a sky"), &spec);
    let whole = 2.0 * 100.0 * base::ops::PI * radius * radius;
    assert!(
        (found.receivers[0].absorbed_w / whole - 1.0).abs() < 0.015,
        "{} of {whole}",
        found.receivers[0].absorbed_w
    );
}

#[test]
fn bright_soil_lights_a_plate_from_below() {
    let mut scene = LitScene { receivers: vec![Optics::BLACK], ..LitScene::default() };
    add_square(&mut scene, DVec3::new(0.0, 5.0, 0.0), DVec3::Y, 0.1, 0);
    let spec = LightSpec { soil_reflectance: 0.5, ..LightSpec::default() };
    let found = lit(&scene, &Beams::sky(SkyKind::Overcast, 100.0).expect("a sky"), &spec);
    // High above a wide plain, its lower side gets what the plain throws back.
    let both = 0.01 * 100.0 * 1.5;
    assert!(
        (found.receivers[0].absorbed_w / both - 1.0).abs() < 0.01,
        "{} of {both}",
        found.receivers[0].absorbed_w
    );
}

#[test]
fn what_is_no_scene_or_no_light_is_refused() {
    let run = Run::plain();
    let (scene, spec) = (plates(&[Optics::LEAF]), LightSpec::default());
    let ask = |scene: &LitScene, beams: &Beams, spec: &LightSpec, run: &Run<'_>| {
        absorb(scene, beams, spec, Seed::new(1), run).expect_err("refused")
    };
    assert_eq!(ask(&LitScene::default(), &sun(40.0), &spec, &run), LightError::Empty);
    assert_eq!(ask(&scene, &Beams::default(), &spec, &run), LightError::Dark);
    let mut far = scene.clone();
    far.points[1].x = f64::NAN;
    assert!(matches!(ask(&far, &sun(40.0), &spec, &run), LightError::FarAway { triangle: 0, .. }));
    let tiny = LightSpec { repeat_m: Some([0.001, 0.001]), lines: 4_000_000, ..spec };
    assert!(matches!(ask(&scene, &sun(40.0), &tiny, &run), LightError::Crowded { .. }));
    for bad in [
        LightSpec { soil_reflectance: f64::NAN, ..spec },
        LightSpec { lines: 10, ..spec },
        LightSpec { repeat_m: Some([0.0, 1.0]), ..spec },
    ] {
        assert!(matches!(ask(&scene, &sun(40.0), &bad, &run), LightError::Range(_)), "{bad:?}");
    }
    let shiny = plates(&[Optics { reflectance: 0.7, transmittance: 0.4 }]);
    assert!(matches!(ask(&shiny, &sun(40.0), &spec, &run), LightError::Range(_)));
    let small = Run { budget: Budget { times: 1e-7, ..Budget::default() }, ..run };
    assert!(matches!(ask(&scene, &sun(40.0), &spec, &small), LightError::OverBudget(_)));
    let cancel = CancelToken::new();
    cancel.cancel();
    assert!(matches!(
        ask(&scene, &sun(40.0), &spec, &Run { cancel: &cancel, ..run }),
        LightError::Cancelled(_)
    ));
}
