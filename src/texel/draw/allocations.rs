//! Slices are chosen and listed without allocating: tests of this crate count what each thread allocates.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::math::Affine3A;
use bevy::prelude::*;

use super::super::build::{VolumeSettings, from_hypertexture};
use super::super::choose::{TexelQuality, TexelView, VolumeMeasure, choose_fading};
use super::super::facet::SurfaceFacets;
use super::super::progress::silent;
use super::super::slice_sets::{SliceBoxes, SliceSets};
use super::super::volume::ReferenceVolume;
use super::component::{TexelSettings, TexelSurface};
use super::geometry::Geometry;
use super::records::SliceRecord;
use super::room::FacetSpace;
use super::source::{DrawnVolume, SeenFrom, SliceSource};

thread_local! {
    /// Other tests run on threads of their own, and are not counted here. It needs no allocation and is never dropped, as an
    /// allocator must have it.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that is ending counts no more.
    let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
}

/// The system's allocator, which counts what is asked of it.
struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

// SAFETY: all is passed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: what the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: what the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: what the caller promises.
        unsafe { System.realloc(place, layout, size) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: what the caller promises.
        unsafe { System.dealloc(place, layout) }
    }
}

/// How often this thread allocates in some work.
fn allocations(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
}

/// Most slices of the volume.
const MOST: u32 = 16;

/// A ball.
fn volume() -> ReferenceVolume {
    let solid = |at: Vec3| (0.8 - at.distance(Vec3::splat(0.5)), Vec3::X);
    let settings = VolumeSettings::new(UVec3::splat(MOST));
    let built = from_hypertexture(solid, &settings, &silent);
    built.expect("the volume is in range").volume
}

/// The facets of a sphere, which are seen from all sides.
fn facets() -> SurfaceFacets {
    let mesh = Sphere::new(1.0).mesh().uv(24, 12);
    let surface = TexelSurface {
        thickness: 0.2,
        ..default()
    };
    let found = surface.facets(&mesh);
    found.expect("a sphere carries texels")
}

/// From an eye, and from a sun.
fn views() -> [SeenFrom; 2] {
    let eye = SeenFrom {
        view: TexelView {
            eye: Vec3::ZERO,
            direction: None,
            pixels: 900.0,
            half_spaces: [Vec4::ZERO; 6],
        },
        eye: Vec3::new(0.4, 0.9, 3.0),
        is_light: false,
        wind: Vec3::new(5.0, 0.0, 2.0),
        time: 1.0,
    };
    let sun = SeenFrom {
        view: TexelView {
            direction: Some(Vec3::new(0.3, -1.0, 0.2)),
            ..eye.view
        },
        is_light: true,
        ..eye
    };
    [eye, sun]
}

#[test]
fn choosing_allocates_nothing() {
    let (facets, measure) = (facets().facets, VolumeMeasure::of(&volume(), MOST));
    let quality = TexelQuality::default();
    let mut axes = 0;
    let allocations = allocations(|| {
        for from in views() {
            for facet in &facets {
                let chosen = choose_fading(facet, &measure, &from.view, &quality);
                axes += chosen.iter().flatten().count();
            }
        }
    });
    assert_eq!(allocations, 0);
    // Without half-spaces all is in view, and has a direction at least.
    assert!(facets.len() > 400 && axes >= 2 * facets.len(), "{axes}");
}

#[test]
fn a_second_frame_lists_its_slices_without_allocating() {
    let volume = volume();
    let drawn = DrawnVolume {
        measure: VolumeMeasure::of(&volume, MOST),
        boxes: Arc::new(SliceBoxes::of(&SliceSets::new(&volume, MOST))),
    };
    let settings = TexelSettings {
        flexibility: 0.01,
        ..default()
    };
    let bounds = Aabb::from_min_max(Vec3::splat(-1.4), Vec3::splat(1.4));
    let geometry = Geometry::new(&facets(), &FacetSpace::default(), usize::MAX);
    let slices = [Entity::PLACEHOLDER; 6];
    let material = AssetId::default();
    let source = SliceSource::new(&geometry, bounds, drawn, settings, slices, material);
    let mut order = Vec::new();
    let mut lists: [Vec<SliceRecord>; 3] = default();
    // As the lists of a frame are made: what was listed is cleared, and not given back.
    let mut frame = || {
        let listed = views().map(|from| {
            lists.iter_mut().for_each(Vec::clear);
            let all = 0..source.facets.len();
            source.list(&Affine3A::IDENTITY, &from, all, &mut order, &mut lists);
            lists.iter().map(Vec::len).sum::<usize>()
        });
        listed.iter().sum::<usize>()
    };
    let (mut first, mut second) = (0, 0);
    let growing = allocations(|| first = frame());
    let grown = allocations(|| second = frame());
    assert!(growing > 0, "lists grow, and that is counted");
    assert_eq!(grown, 0);
    assert!(first > 100 && second == first, "{first} {second}");
}
