//! The core of `examples/speed_accuracy`, at a size that takes seconds: the shape of its conclusions, and no times.

use bevy::prelude::*;
use bevy_verdure::frusta::ReliefSteps;
use bevy_verdure::lab::rivals::{
    AS_GOOD, Exhibit, Judge, March, Rival, SUPERSAMPLING, Wardrobe, Weight, aim, fitting,
};
use bevy_verdure::lab::{GeometryError, GpuClockPlugin, Race, Shot, Studio, Variant};
use bevy_verdure::plants::{Planting, Saguaro};

/// A saguaro, before an eye that it fills the picture of.
struct Stand {
    studio: Studio,
    exhibit: Exhibit,
    wardrobe: Wardrobe,
    shot: Shot,
}

impl Stand {
    fn new() -> Self {
        let mut studio = Studio::new(|app| {
            app.add_plugins(GpuClockPlugin);
        });
        let mut planting = Planting::default();
        let saguaro = planting.add(Saguaro::default().grow(1));
        planting.place(saguaro, Vec3::ZERO, 0.0, 1.0);
        let shot = fitting(&planting, Vec3::new(0.3, 0.2, 1.0), UVec2::new(160, 120));
        Self {
            exhibit: Exhibit::open(&mut studio.headless, planting, None),
            studio,
            wardrobe: Wardrobe::default(),
            shot,
        }
    }

    fn put_up(&mut self, rival: Rival) -> Weight {
        let (headless, wardrobe) = (&mut self.studio.headless, &mut self.wardrobe);
        self.exhibit
            .put_up(headless, wardrobe, rival, 1 << 28)
            .unwrap()
    }

    fn judge(&mut self, reference: Rival) -> Judge {
        self.put_up(reference);
        Judge::new(&mut self.studio, &self.exhibit, reference, self.shot)
    }

    fn flip(&mut self, judge: &Judge, rival: Rival) -> f32 {
        self.put_up(rival);
        let flip = judge.flip(&mut self.studio, &self.exhibit, rival);
        println!("{rival:?}: FLIP {flip:.5}");
        flip
    }
}

fn in_steps(steps: u32) -> Rival {
    Rival::Frusta(Some(March {
        steps: ReliefSteps::Fixed(steps),
        ..default()
    }))
}

fn polygons(subdivisions: u32, relief: bool) -> Rival {
    Rival::Polygons {
        subdivisions,
        relief,
    }
}

/// Each is below the one before by more than a hundredth of it.
fn falls(errors: &[f32]) -> bool {
    errors.windows(2).all(|two| two[1] < 0.99 * two[0])
}

#[test]
fn smooth_polygons_come_closer_by_subdivision_and_weigh_twelve_times_frusta() {
    let mut stand = Stand::new();
    let judge = stand.judge(Rival::reference(false));
    let frusta = stand.flip(&judge, Rival::frusta(false));
    let rivals = [0, 1, 2].map(|m| stand.flip(&judge, polygons(m, false)));
    assert!(falls(&rivals), "{rivals:?}");
    assert!(frusta < rivals[0]);
    let own = stand.put_up(Rival::frusta(false));
    for m in [1, 2] {
        let other = stand.put_up(polygons(m, false));
        assert!(12 * own.shape() < other.shape(), "{own:?} {other:?}");
    }
    let found = judge.match_polygons(
        &mut stand.studio,
        &mut stand.exhibit,
        &mut stand.wardrobe,
        false,
        frusta,
        (4, 1 << 28),
    );
    let found = found.unwrap();
    assert!(found.reached && found.subdivisions > 0, "{found:?}");
    let (last, worse) = found.tried.split_last().unwrap();
    assert!(
        last.nearer() <= frusta + AS_GOOD && worse.iter().all(|one| one.nearer() > last.nearer())
    );
}

#[test]
fn polygons_beyond_their_memory_are_not_put_up() {
    let mut stand = Stand::new();
    let (headless, wardrobe) = (&mut stand.studio.headless, &mut stand.wardrobe);
    let put_up = stand
        .exhibit
        .put_up(headless, wardrobe, polygons(5, false), 1 << 20);
    assert!(put_up.unwrap_err().to_string().contains("1048576"));
}

#[test]
fn relief_comes_closer_by_steps_and_polygons_by_subdivision() {
    let mut stand = Stand::new();
    // So near that a ridge is several pixels wide: from further off, what a pixel averages over hides the steps.
    stand.shot.eye = Vec3::new(0.4, 1.55, 0.9);
    stand.shot.at = Vec3::new(0.0, 1.4, 0.0);
    let finest = Rival::reference(true);
    let judge = stand.judge(finest);
    let flat = stand.flip(&judge, Rival::frusta(false));
    let default = stand.flip(&judge, Rival::frusta(true));
    let finest_flip = stand.flip(&judge, finest);
    let steps = [2, 4, 24].map(|steps| stand.flip(&judge, in_steps(steps)));
    assert!(falls(&steps), "{steps:?}");
    // The default is nearly as good as the finest there is, and much nearer to it than no relief at all.
    assert!(default < 1.25 * finest_flip && default < 0.3 * flat);
    // From where there are more vertices than ridges: below, they hit and miss them at random.
    let rivals = [2, 3, 4].map(|m| stand.flip(&judge, polygons(m, true)));
    assert!(falls(&rivals), "{rivals:?}");
    assert!(default < rivals[1]);
    let (own, other) = (
        stand.put_up(Rival::frusta(true)),
        stand.put_up(polygons(4, true)),
    );
    assert!(12 * own.shape() < other.shape(), "{own:?} {other:?}");

    let exact = judge.figures(&mut stand.studio, &stand.exhibit, finest);
    let [few, many] = [2, 24].map(|steps| {
        let own = judge.figures(&mut stand.studio, &stand.exhibit, in_steps(steps));
        GeometryError::between(&exact, &own)
    });
    println!("{few:?}\n{many:?}");
    assert!(many.pixels > 500 && many.worst_depth < few.worst_depth);
    assert!(many.wrong_segments <= few.wrong_segments && many.wrong_segments < 0.01);
    let none = GeometryError::between(&exact, &exact);
    assert_eq!((none.worst_depth, none.wrong_segments), (0.0, 0.0));
}

#[test]
fn a_race_times_every_variant_and_leaves_the_scene_as_the_last_one_made_it() {
    let mut stand = Stand::new();
    let (frusta, rival) = (Rival::frusta(false), polygons(1, false));
    stand.put_up(frusta);
    stand.put_up(rival);
    aim(&mut stand.studio, &stand.shot);
    let exhibit = &stand.exhibit;
    let mut variants = [None, Some(frusta), Some(rival)].map(|shown| {
        Variant::new(format!("{shown:?}"), move |headless| {
            exhibit.show(headless, shown);
        })
    });
    let race = Race {
        rounds: 3,
        warm_up: 1,
        settle: 1,
    };
    let mut looks = Vec::new();
    let timings = race.run_and_look(&mut stand.studio.headless, &mut variants, |i, _| {
        looks.push(i);
    });
    assert_eq!(looks, [0, 1, 2, 0, 1, 2, 0, 1, 2]);
    let has_timestamps = bevy_verdure::lab::has_timestamps(stand.studio.world());
    for (timing, variant) in timings.iter().zip(&variants) {
        assert_eq!((&timing.name, timing.frames), (&variant.name, 3));
        assert!(timing.frame_ms > 0.0);
        assert_eq!(timing.gpu_ms.is_some(), has_timestamps, "{timing:?}");
    }
    let own = timings[0].less(&timings[0]);
    assert_eq!(own.frame_ms, 0.0);
    assert_eq!(SUPERSAMPLING, 4);
}
