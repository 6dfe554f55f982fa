//! The dances. An ordinary system turns segment entities; the plants follow.

use core::f32::consts::TAU;

use bevy::prelude::*;
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;

/// Beats a minute.
const TEMPO: f32 = 116.0;

/// How one cactus dances.
#[derive(Component)]
pub struct Dancer {
    pub trunk: Vec<u32>,
    pub arms: [Vec<u32>; 2],
    step: Step,
    /// Where in the beat this one is.
    phase: f32,
    /// How far it goes.
    zest: f32,
    /// Direction of its sway.
    heading: f32,
}

enum Step {
    /// From side to side, arms trailing.
    Sway,
    /// Round and round, like a hula.
    Hula,
    /// A wave that climbs the trunk.
    Wave,
    /// Bowing to the beat, arms up.
    Bow,
    /// Arms going up in turn.
    Signal,
}

impl Dancer {
    pub fn new(trunk: Vec<u32>, arms: [Vec<u32>; 2], dice: &mut Dice) -> Self {
        let step = match (dice.roll() * 5.0) as u32 {
            0 => Step::Sway,
            1 => Step::Hula,
            2 => Step::Wave,
            3 => Step::Bow,
            _ => Step::Signal,
        };
        Self {
            trunk,
            arms,
            step,
            phase: dice.between(-0.04, 0.04) + if dice.roll() < 0.5 { 0.5 } else { 0.0 },
            zest: dice.between(0.75, 1.25),
            heading: dice.between(0.0, TAU),
        }
    }

    /// The lean of the trunk `h` of the way up, as a vector across it in radians, `beat` beats into the song.
    fn lean(&self, beat: f32, h: f32) -> Vec2 {
        let swing = |rate: f32, lag: f32| (TAU * (beat * rate + self.phase - lag)).sin();
        let side = match self.step {
            Step::Sway => Vec2::new(0.75 * swing(0.5, 0.12 * h), 0.12 * swing(1.0, 0.0)),
            Step::Hula => Vec2::new(
                0.62 * swing(0.5, 0.2 * h),
                0.62 * swing(0.5, 0.2 * h + 0.25),
            ),
            Step::Wave => Vec2::new(1.5 * (0.35 + h) * swing(0.5, 0.75 * h), 0.0),
            Step::Bow => Vec2::new(0.55 + 0.55 * swing(1.0, 0.1 * h), 0.15 * swing(0.25, 0.0)),
            Step::Signal => Vec2::new(0.4 * swing(0.5, 0.1 * h), 0.25 * swing(0.25, 0.1)),
        };
        Vec2::from_angle(self.heading).rotate(side) * self.zest
    }

    /// How far an arm swings out, in radians a segment.
    fn arm(&self, beat: f32, side: usize) -> f32 {
        let turn = side as f32 * 0.5;
        let swing = (TAU * (beat * 0.5 + self.phase + turn)).sin();
        let reach = match self.step {
            Step::Sway | Step::Hula => 0.16 * swing,
            Step::Wave => 0.22 * swing,
            Step::Bow => -0.08 + 0.2 * (TAU * (beat + self.phase)).sin(),
            Step::Signal => 0.05 + 0.3 * swing,
        };
        reach * self.zest
    }
}

/// Turns every cactus's segments to the beat.
pub fn dance(
    time: Res<Time>,
    dancers: Query<(&Dancer, &SegmentEntities, &Skeleton3d)>,
    skeletons: Res<Assets<Skeleton>>,
    mut segments: Query<&mut Transform, With<SkeletonSegment>>,
) {
    let beat = time.elapsed_secs() * TEMPO / 60.0;
    for (dancer, entities, skeleton) in &dancers {
        let Some(skeleton) = skeletons.get(&skeleton.0) else {
            continue;
        };
        let share = 1.0 / dancer.trunk.len() as f32;
        for (i, joint) in dancer.trunk.iter().enumerate() {
            // The foot stands firm; each segment adds its share of the lean.
            let h = (i + 1) as f32 * share;
            let lean = dancer.lean(beat, h) * share * (0.25 + 1.5 * h).min(1.3);
            turn(
                &mut segments,
                entities,
                *joint,
                Quat::from_scaled_axis(Vec3::new(lean.y, 0.0, -lean.x)),
            );
        }
        for (side, arm) in dancer.arms.iter().enumerate() {
            let swing = dancer.arm(beat, side);
            let shoulder = skeleton.joints()[arm[0] as usize].position.with_y(0.0);
            let axis = shoulder.normalize_or(Vec3::X).cross(Vec3::Y);
            for joint in arm {
                turn(
                    &mut segments,
                    entities,
                    *joint,
                    Quat::from_axis_angle(axis, swing),
                );
            }
        }
    }
}

fn turn(
    segments: &mut Query<&mut Transform, With<SkeletonSegment>>,
    entities: &SegmentEntities,
    joint: u32,
    rotation: Quat,
) {
    if let Some(mut segment) = entities
        .get(joint as usize)
        .and_then(|entity| segments.get_mut(entity).ok())
    {
        segment.rotation = rotation;
    }
}
