//! Polygons to triangles.

/// The most corners of a polygon that is not convex: cutting ears takes time quadratic in them.
const MOST_CONCAVE_CORNERS: usize = 4096;

type Point = [f64; 3];

/// Why a polygon cannot be cut into triangles.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct TooManyCorners;

/// Appends the triangles of a polygon to `triangles`, as indices of its corners and in its winding;
/// those without area are left out.
pub(crate) fn triangulate(corners: &[Point], triangles: &mut Vec<[u32; 3]>) -> Result<(), TooManyCorners> {
    let first = triangles.len();
    if corners.len() == 3 {
        triangles.push([0, 1, 2]);
    } else {
        let flat = flatten(corners);
        if is_convex(&flat) {
            triangles.extend((2..corners.len() as u32).map(|i| [0, i - 1, i]));
        } else if corners.len() <= MOST_CONCAVE_CORNERS {
            cut_ears(&flat, triangles);
        } else {
            return Err(TooManyCorners);
        }
    }
    let mut kept = first;
    for i in first..triangles.len() {
        let [a, b, c] = triangles[i].map(|k| corners[k as usize]);
        if cross(sub(b, a), sub(c, a)) != [0.0; 3] {
            triangles[kept] = triangles[i];
            kept += 1;
        }
    }
    triangles.truncate(kept);
    Ok(())
}

/// The polygon seen along the axis that its area vector (by Newell) is closest to, counter-clockwise.
fn flatten(corners: &[Point]) -> Vec<[f64; 2]> {
    let mut area = [0.0; 3];
    for i in 1..corners.len() - 1 {
        let c = cross(sub(corners[i], corners[0]), sub(corners[i + 1], corners[0]));
        area = [area[0] + c[0], area[1] + c[1], area[2] + c[2]];
    }
    let size = area.map(f64::abs);
    let axis = if size[2] >= size[0] && size[2] >= size[1] {
        2
    } else if size[1] >= size[0] {
        1
    } else {
        0
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if area[axis] < 0.0 { (v, u) } else { (u, v) };
    corners.iter().map(|p| [p[u], p[v]]).collect()
}

fn is_convex(polygon: &[[f64; 2]]) -> bool {
    let n = polygon.len();
    (0..n).all(|i| turn(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]) >= 0.0)
}

/// Cuts off corners whose triangle holds no other corner, until three are left. Whether a corner can be
/// cut off changes only for the neighbours of the one cut, which keeps the time quadratic.
fn cut_ears(polygon: &[[f64; 2]], triangles: &mut Vec<[u32; 3]>) {
    let mut ring: Vec<usize> = (0..polygon.len()).collect();
    let mut ears: Vec<bool> = (0..ring.len()).map(|i| is_ear(polygon, &ring, i)).collect();
    while ring.len() > 3 {
        // A polygon that crosses itself may have no ear: then any corner is as good as another.
        let cut = ears.iter().position(|ear| *ear).unwrap_or(0);
        let n = ring.len();
        let (before, after) = (ring[(cut + n - 1) % n], ring[(cut + 1) % n]);
        triangles.push([before as u32, ring[cut] as u32, after as u32]);
        ring.remove(cut);
        ears.remove(cut);
        let n = n - 1;
        for neighbour in [(cut + n - 1) % n, cut % n] {
            ears[neighbour] = is_ear(polygon, &ring, neighbour);
        }
    }
    triangles.push([ring[0] as u32, ring[1] as u32, ring[2] as u32]);
}

fn is_ear(polygon: &[[f64; 2]], ring: &[usize], at: usize) -> bool {
    let n = ring.len();
    let [a, b, c] = [(at + n - 1) % n, at, (at + 1) % n].map(|i| polygon[ring[i]]);
    let size = turn(a, b, c);
    if size <= 0.0 {
        return size == 0.0;
    }
    ring.iter().map(|i| polygon[*i]).all(|p| {
        p == a || p == b || p == c || turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0
    })
}

/// Twice the signed area of a triangle; positive for a turn to the left at `b`.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

pub(super) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[Point]) -> (f64, usize) {
        let mut triangles = Vec::new();
        triangulate(polygon, &mut triangles).unwrap();
        let sum = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|k| polygon[k as usize]);
                let size = cross(sub(b, a), sub(c, a))[2] / 2.0;
                assert!(size > 0.0, "{t:?} is turned over");
                size
            })
            .sum();
        (sum, triangles.len())
    }

    #[test]
    fn a_square_is_two_triangles() {
        assert_eq!(area(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]), (1.0, 2));
    }

    #[test]
    fn an_arrow_head_is_not_a_fan() {
        // The notch is where a fan from corner 0 would cover it, and where it would not.
        assert_eq!(area(&[[0., 3., 0.], [-2., 0., 0.], [0., 1., 0.], [2., 0., 0.]]), (4.0, 2));
        assert_eq!(area(&[[2., 0., 0.], [0., 3., 0.], [-2., 0., 0.], [0., 1., 0.]]), (4.0, 2));
    }

    #[test]
    fn a_comb_is_covered_exactly() {
        let mut polygon: Vec<Point> = vec![[20., -1., 0.]];
        for i in (0..20).rev() {
            polygon.push([f64::from(i) + 0.5, 5., 0.]);
            polygon.push([f64::from(i), 0., 0.]);
        }
        polygon.push([0., -1., 0.]);
        polygon.rotate_left(7);
        let (size, count) = area(&polygon);
        let expected = shoelace(&polygon);
        assert!((size - expected).abs() < 1e-9 && count <= polygon.len() - 2);
    }

    fn shoelace(p: &[Point]) -> f64 {
        (0..p.len())
            .map(|i| (p[i], p[(i + 1) % p.len()]))
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum::<f64>()
            / 2.0
    }

    #[test]
    fn collinear_corners_cost_no_area() {
        assert_eq!(area(&[[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [2., 1., 0.], [0., 1., 0.]]).0, 2.0);
        let mut none = Vec::new();
        triangulate(&[[0.; 3], [1.; 3], [2.; 3], [3.; 3]], &mut none).unwrap();
        assert!(none.is_empty());
    }

    #[test]
    fn a_huge_jagged_polygon_is_refused() {
        let polygon: Vec<Point> = (0..5000)
            .map(|i| [f64::from(i), f64::from(i % 2) + if i == 0 { 9.0 } else { 0.0 }, 0.0])
            .collect();
        assert_eq!(triangulate(&polygon, &mut Vec::new()), Err(TooManyCorners));
    }
}
