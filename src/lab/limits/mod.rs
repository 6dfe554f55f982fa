//! Where the methods fail: experiments in plain arithmetic, without a GPU, each with its chart.
//!
//! An experiment drives one setting past the point at which a method is no longer right, and says by how much it is
//! wrong then. What is measured, where it starts to fail and what the crate does there is told in `docs/limits.md`, and
//! in `docs/texels_limits.md`; `--example limits` draws the charts again.
//!
//! | file | question |
//! |---|---|
//! | [`seams`] | how wide do joins gape when a limb bends and tapers? |
//! | [`precision`] | how deep is the error of 32 bits, however far away the eye is? |
//! | [`degenerate`] | the same near cylinders, along the surface and through a cone's apex |
//! | [`steps`] | which ridges does a march of few steps miss? |
//! | [`swimming`] | how far off is a v that is interpolated along the ray? |
//! | [`misfit`] | how far apart are both sides' u at a mitre? |
//! | [`thickness`] | what happens to a shell thicker than the bend has room for? |
//! | [`inside`] | does an eye inside the shell still see the relief? |
//! | [`texels`] | when do slices gape, and filling fail? |
//!
//! `limb` has the limbs that these are tried on, `shell` marches a ray through the shell as §3 does, `random` rolls the
//! dice.

pub mod degenerate;
pub mod inside;
mod limb;
pub mod misfit;
pub mod precision;
mod random;
pub mod seams;
mod shell;
pub mod steps;
pub mod swimming;
pub mod texels;
pub mod thickness;

use super::charts::{Axis, Chart, Series};

/// An experiment: the name of its files, and what makes its chart.
pub type Experiment = (&'static str, fn() -> Chart);

/// All experiments.
pub const EXPERIMENTS: [Experiment; 12] = [
    ("limits_seams", seams::chart),
    ("limits_precision", precision::chart),
    ("limits_lost_rays", precision::lost_rays_chart),
    ("limits_degenerate", degenerate::chart),
    ("limits_steps", steps::chart),
    ("limits_swimming", swimming::chart),
    ("limits_misfit", misfit::chart),
    ("limits_thickness", thickness::chart),
    ("limits_inside", inside::chart),
    ("texels_gaps", texels::gaps::chart),
    ("texels_criteria", texels::criteria::chart),
    ("texels_filling", texels::filling::chart),
];

/// A chart of what is the same on every machine.
fn chart(title: &str, x: Axis, y: Axis, series: Vec<Series>) -> Chart {
    Chart {
        title: title.into(),
        subtitle: "arithmetic on the CPU, the same on every machine".into(),
        x,
        y,
        series,
    }
}
