#define_import_path bevy_verdure::texel::facet

// One triangle of the surface and the texels on it (§2.1, Figure 2): what facet/ is, by the same names.

struct Facet {
    // A and H of the three vertices, and their texture coordinates.
    positions: mat3x3<f32>,
    heights: mat3x3<f32>,
    uvs: mat3x2<f32>,
}

// Derivatives of the place by u, v and w.
struct TexelFrame {
    edges: mat3x3<f32>,
}

fn corners(facet: Facet, w: f32) -> mat3x3<f32> {
    return facet.positions + facet.heights * w;
}

fn facet_point(facet: Facet, b: vec3<f32>, w: f32) -> vec3<f32> {
    let at = corners(facet, w);
    return at[0] * b.x + at[1] * b.y + at[2] * b.z;
}

fn facet_uv(facet: Facet, b: vec3<f32>) -> vec2<f32> {
    return facet.uvs[0] * b.x + facet.uvs[1] * b.y + facet.uvs[2] * b.z;
}

fn texel_frame(facet: Facet, b: vec3<f32>, w: f32) -> TexelFrame {
    let at = corners(facet, w);
    let s = facet.uvs[1] - facet.uvs[0];
    let t = facet.uvs[2] - facet.uvs[0];
    let along_s = at[1] - at[0];
    let along_t = at[2] - at[0];
    let det = s.x * t.y - s.y * t.x;
    return TexelFrame(mat3x3(
        (along_s * t.y - along_t * s.y) / det,
        (along_t * s.x - along_s * t.x) / det,
        facet.heights[0] * b.x + facet.heights[1] * b.y + facet.heights[2] * b.z,
    ));
}

// A direction as changes of u, v and w.
fn in_frame(frame: TexelFrame, direction: vec3<f32>) -> vec3<f32> {
    let u = frame.edges[0];
    let v = frame.edges[1];
    let w = frame.edges[2];
    let cofactors = mat3x3(cross(v, w), cross(w, u), cross(u, v));
    return (direction * cofactors) / dot(u, cofactors[0]);
}

// What turns normals of the volume, which are in metres of a box of some `lengths`, to the space of the facet.
fn normal_transform(frame: TexelFrame, lengths: vec3<f32>) -> mat3x3<f32> {
    let u = frame.edges[0];
    let v = frame.edges[1];
    let w = frame.edges[2];
    let turned = sign(dot(u, cross(v, w)));
    return mat3x3(
        cross(v, w) * (lengths.x * turned),
        cross(w, u) * (lengths.y * turned),
        cross(u, v) * (lengths.z * turned));
}

// The frame with u and v turned as a facet's normal is to another one, so that facets of a bent surface are shaded as one.
fn smooth_frame(frame: TexelFrame, normal: vec3<f32>) -> TexelFrame {
    let across = cross(frame.edges[0], frame.edges[1]);
    let flat_normal = normalize(across * sign(dot(across, frame.edges[2])));
    let axis = cross(flat_normal, normal);
    // The least rotation, of which the axis is as long as the sine.
    let along = 1.0 + dot(flat_normal, normal);
    if dot(normal, normal) < 0.5 || along < 0.1 {
        return frame;
    }
    let u = frame.edges[0];
    let v = frame.edges[1];
    return TexelFrame(mat3x3(
        u + cross(axis, u) + cross(axis, cross(axis, u)) / along,
        v + cross(axis, v) + cross(axis, cross(axis, v)) / along,
        frame.edges[2],
    ));
}

fn uv_along(axis: u32, uv: vec2<f32>) -> f32 {
    return select(uv.y, uv.x, axis == 0u);
}

fn slice_position(slice: i32, count: u32, apart: f32) -> f32 {
    let even = slice & ~1;
    let odd = slice & 1;
    return (f32(even) + 1.0 + (f32(odd) - 0.5) * apart) / f32(count);
}

// The weights of one end of the line in which u (or v) has the value `position`: on the first, or the last, edge that it
// meets. The line must meet the facet.
fn slice_line_end(uvs: mat3x2<f32>, axis: u32, position: f32, last: bool) -> vec3<f32> {
    let values = vec3(uv_along(axis, uvs[0]), uv_along(axis, uvs[1]), uv_along(axis, uvs[2]));
    let beyond = values >= vec3(position);
    // Of the edges 0 to 1, 1 to 2 and 2 to 0 the line meets two.
    let meets = beyond != beyond.yzx;
    var edge = 0u;
    if last {
        edge = select(1u, 2u, meets.z);
    } else {
        edge = select(1u, 0u, meets.x);
    }
    if edge == 0u {
        let t = edge_share(values.x, values.y, position);
        return vec3(1.0 - t, t, 0.0);
    }
    if edge == 1u {
        let t = edge_share(values.y, values.z, position);
        return vec3(0.0, 1.0 - t, t);
    }
    let t = edge_share(values.z, values.x, position);
    return vec3(t, 0.0, 1.0 - t);
}

// The weights at a share of that line. At its ends they are theirs to the last bit, so that facets meet.
fn slice_line_point(uvs: mat3x2<f32>, axis: u32, position: f32, share: f32) -> vec3<f32> {
    let nearer = slice_line_end(uvs, axis, position, share > 0.5);
    let other = slice_line_end(uvs, axis, position, share <= 0.5);
    return nearer + (other - nearer) * min(share, 1.0 - share);
}

// The share of the second vertex. From the lower end, whichever facet asks.
fn edge_share(first: f32, second: f32, position: f32) -> f32 {
    let low = min(first, second);
    let t = (position - low) / (max(first, second) - low);
    return select(1.0 - t, t, first < second);
}
