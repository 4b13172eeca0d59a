//! The tree against a model that follows the report's pseudo code 1 word by word: every candidate counted by looking at every triangle,
//! costs compared as fractions with the node's surface below the line.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;

/// A node of the model: box, and either (axis, plane, children) or the packet.
#[derive(Debug, PartialEq)]
enum NaiveTree {
    Inner(Bounds, usize, i32, Box<(NaiveTree, NaiveTree)>),
    Leaf(Bounds, Vec<u32>),
}

/// Surface of a box, in square units.
fn surface(b: &Bounds) -> i128 {
    let side = |axis: usize| i128::from(b.high[axis]) - i128::from(b.low[axis]);
    2 * (side(0) * side(1) + side(1) * side(2) + side(0) * side(2))
}

fn model(packet: Vec<u32>, triangles: &[Bounds], node: Bounds, levels: u32) -> NaiveTree {
    let sides = [0, 1, 2].map(|k| i64::from(node.high[k]) - i64::from(node.low[k]));
    let longest = *sides.iter().max().unwrap();
    let axis = sides.iter().position(|&side| side == longest).unwrap();
    let area = surface(&node);
    if levels == 0 || area == 0 {
        return NaiveTree::Leaf(node, packet);
    }
    // Collect the candidates: both ends of every triangle, strictly inside of the node
    let extent = |&i: &u32| (triangles[i as usize].low[axis], triangles[i as usize].high[axis]);
    let mut candidates: Vec<i32> = packet.iter().map(extent).flat_map(|(low, high)| [low, high]).collect();
    candidates.retain(|&s| node.low[axis] < s && s < node.high[axis]);
    candidates.sort_unstable();
    let mut lowest = packet.len() as i128 * area;
    let mut found = None;
    // Count and price each candidate, times the node's area; what lies in the plane goes left where that costs no more
    for s in candidates {
        let left = packet.iter().map(extent).filter(|&(low, high)| low < s && high <= s).count() as i128;
        let right = packet.iter().map(extent).filter(|&(low, high)| low >= s && high > s).count() as i128;
        let both = packet.iter().map(extent).filter(|&(low, high)| low < s && high > s).count() as i128;
        let flat = packet.iter().map(extent).filter(|&(low, high)| low == s && high == s).count() as i128;
        let (mut below, mut above) = (node, node);
        below.high[axis] = s;
        above.low[axis] = s;
        let cost = |nl: i128, nr: i128| area + surface(&below) * (nl + both) + surface(&above) * (nr + both);
        let (to_left, to_right) = (cost(left + flat, right), cost(left, right + flat));
        let is_right = to_right < to_left;
        let here = if is_right { to_right } else { to_left };
        if here < lowest {
            lowest = here;
            found = Some((s, is_right, below, above));
        }
    }
    // Divide at the cheapest candidate, the lowest of equal ones; where none is cheaper than a leaf, it stays one
    let Some((s, is_right, below, above)) = found else { return NaiveTree::Leaf(node, packet) };
    let is_flat = |i: &u32| extent(i) == (s, s);
    let lower = packet.iter().copied().filter(|i| extent(i).0 < s || is_flat(i) && !is_right).collect();
    let upper = packet.iter().copied().filter(|i| extent(i).1 > s || is_flat(i) && is_right).collect();
    let children = (model(lower, triangles, below, levels - 1), model(upper, triangles, above, levels - 1));
    NaiveTree::Inner(node, axis, s, Box::new(children))
}

fn as_model(tree: &KdTree, number: u32) -> NaiveTree {
    let node = tree.nodes().nth(number as usize).unwrap();
    match node.content {
        Content::Leaf { triangles } => NaiveTree::Leaf(node.bounds, triangles.to_vec()),
        Content::Inner { axis, at, left } => {
            NaiveTree::Inner(node.bounds, axis, at, Box::new((as_model(tree, left), as_model(tree, left + 1))))
        }
    }
}

/// The numbers of the nodes level by level, from left to right, by walking down from the root.
fn levels(tree: &KdTree) -> Vec<Vec<u32>> {
    let mut levels = vec![vec![0]];
    loop {
        let below: Vec<u32> = levels[levels.len() - 1]
            .iter()
            .filter_map(|&number| match tree.content(number) {
                Content::Inner { left, .. } => Some([left, left + 1]),
                Content::Leaf { .. } => None,
            })
            .flatten()
            .collect();
        if below.is_empty() {
            return levels;
        }
        levels.push(below);
    }
}

/// Triangles with these boxes.
fn with_boxes(boxes: &[Bounds]) -> Vec<[[i32; 3]; 3]> {
    boxes.iter().map(|bounds| [bounds.low, bounds.high, bounds.low]).collect()
}

fn check(triangles: &[Bounds], unit: i32, depth: u32) -> KdTree {
    let root = triangles
        .iter()
        .copied()
        .reduce(|a, b| a.union(&b))
        .unwrap_or(Bounds { low: [0; 3], high: [0; 3] })
        .enlarged(unit);
    let tree = build(&with_boxes(triangles), root, Depth::Levels(depth), BuildMethod::Report).unwrap();
    assert_eq!(as_model(&tree, 0), model((0..triangles.len() as u32).collect(), triangles, root, depth));
    let nexts: Vec<Option<u32>> = tree.nodes().map(|node| node.next).collect();
    let mut expected = 0;
    for level in levels(&tree) {
        for (place, &number) in level.iter().enumerate() {
            assert_eq!(number, expected, "nodes are stored level by level");
            expected += 1;
            assert_eq!(nexts[number as usize], level.get(place + 1).copied());
        }
    }
    assert_eq!(expected as usize, tree.count());
    tree
}

fn bounds(low: [i32; 3], high: [i32; 3]) -> Bounds {
    Bounds { low, high }
}

/// Triangles as boxes whose corners lie on few different coordinates, so that ties, flat boxes and equal costs are common.
fn boxes(range: i32, most: usize) -> impl Strategy<Value = Vec<Bounds>> {
    let corner = || prop::array::uniform3(-range..=range);
    prop::collection::vec(prop::array::uniform3(corner()).prop_map(|v| Bounds::of_triangle(&v)), 0..most)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn it_is_the_tree_of_the_literal_rule_where_bounds_often_coincide(triangles in boxes(3, 24), depth in 0u32..7) {
        check(&triangles, 1, depth);
    }

    #[test]
    fn it_is_the_tree_of_the_literal_rule_at_the_ends_of_the_grid(triangles in boxes((1 << 30) - 4, 40), depth in 0u32..17) {
        check(&triangles, 1, depth);
    }

    #[test]
    fn it_is_the_tree_of_the_literal_rule_for_small_triangles(
        triangles in prop::collection::vec((prop::array::uniform3(-500..500), prop::array::uniform3(0..9)), 0..60),
        unit in 0..3,
    ) {
        let triangles: Vec<Bounds> =
            triangles.into_iter().map(|(low, side)| bounds(low, [0, 1, 2].map(|k| low[k] + side[k]))).collect();
        check(&triangles, unit, DEPTH);
    }
}

#[test]
fn no_triangles_give_one_empty_leaf() {
    let tree = check(&[], 1, DEPTH);
    assert_eq!(tree.count(), 1);
    assert_eq!(tree.statistics().empty_leaves, 1);
    assert_eq!(tree.statistics().depth, 0);
}

#[test]
fn a_flat_node_stays_whole() {
    let apart = [bounds([0, 0, 0], [1, 0, 0]), bounds([100, 0, 0], [101, 0, 0])];
    assert_eq!(check(&apart, 0, DEPTH).count(), 1, "surface 0");
    assert!(check(&apart, 1, DEPTH).count() == 1, "2 triangles never pay for a division that costs 1");
    let many: Vec<Bounds> = (0..8).map(|k| bounds([k * 100, 0, 0], [k * 100 + 1, 0, 0])).collect();
    assert_eq!(check(&many, 0, DEPTH).count(), 1);
    assert!(check(&many, 1, DEPTH).count() > 1);
}

#[test]
fn triangles_in_the_plane_go_to_the_cheaper_side() {
    // Along x from -1 to 101: eight flat triangles at 20. The left child is smaller and takes them.
    let mut triangles = vec![bounds([20, 0, 0], [20, 50, 50]); 8];
    triangles.push(bounds([0, 0, 0], [100, 50, 50]));
    let tree = check(&triangles, 1, 1);
    let Content::Inner { axis: 0, at: 20, left: 1 } = tree.content(0) else { panic!("{:?}", tree.content(0)) };
    assert_eq!(tree.content(1), Content::Leaf { triangles: &[0, 1, 2, 3, 4, 5, 6, 7, 8] });
    assert_eq!(tree.content(2), Content::Leaf { triangles: &[8] });
    // Mirrored, the right one does.
    for triangle in &mut triangles {
        (triangle.low[0], triangle.high[0]) = (100 - triangle.high[0], 100 - triangle.low[0]);
    }
    let tree = check(&triangles, 1, 1);
    assert_eq!(tree.content(1), Content::Leaf { triangles: &[8] });
    // Exactly between, the left one.
    for triangle in &mut triangles[..8] {
        (triangle.low[0], triangle.high[0]) = (50, 50);
    }
    let tree = check(&triangles, 1, 1);
    assert_eq!(tree.content(2), Content::Leaf { triangles: &[8] });
}

#[test]
fn equal_costs_take_the_lowest_coordinate_and_equal_sides_the_first_axis() {
    // Two packets that mirror each other: planes at -10 and 10 cost the same.
    let packet = |x: i32| bounds([x.min(x * 9), -90, -90], [x.max(x * 9), 90, 90]);
    let triangles: Vec<Bounds> = [packet(10); 5].into_iter().chain([packet(-10); 5]).collect();
    let tree = check(&triangles, 1, 1);
    assert!(matches!(tree.content(0), Content::Inner { axis: 0, at: -10, .. }), "{:?}", tree.content(0));
}

#[test]
fn the_depth_limit_holds() {
    let triangles: Vec<Bounds> = (0..1000).map(|k| bounds([k * 64, 0, 0], [k * 64 + 32, 9, 9])).collect();
    for depth in [0, 1, 2, 5, DEPTH] {
        assert!(check(&triangles, 1, depth).statistics().depth <= depth);
    }
    assert_eq!(check(&triangles, 1, 3).statistics().depth, 3);
}

#[test]
fn the_statistics_of_a_small_tree_are_right() {
    let many: Vec<Bounds> = (0..4).map(|k| bounds([k * 100, 0, 0], [k * 100 + 1, 50, 50])).collect();
    let tree = check(&many, 1, 1);
    // The root's plane lies at 1, 100, 101, 200, 201 or 300; whichever it is, no triangle straddles it.
    let statistics = tree.statistics();
    assert_eq!((statistics.nodes, statistics.leaves, statistics.empty_leaves), (3, 2, 0));
    assert_eq!((statistics.references, statistics.depth, statistics.mean_triangles), (4, 1, 2.0));
    // The halves of a box of 303 x 52 x 52: 1 + (SA(left) n(left) + SA(right) n(right)) / SA(root).
    let half = |side: f64| side * 104.0 + 2704.0;
    let Content::Inner { at, .. } = tree.content(0) else { panic!("one division") };
    let (left, right) = (f64::from(at + 1), f64::from(302 - at));
    let below = many.iter().filter(|bounds| bounds.low[0] < at).count() as f64;
    let expected = 1.0 + (half(left) * below + half(right) * (4.0 - below)) / half(303.0);
    assert!((statistics.expected_cost - expected).abs() < 1e-12, "{statistics:?}, {expected}");
}

/// A landscape of 2 n^2 triangles.
fn terrain(n: i32) -> Vec<[[i32; 3]; 3]> {
    let height = |x: i32, z: i32| ((x * 37 + z * 91) % 101 + (x * x + z * 3) % 57) * 300_000;
    let step = 2_000_000_000 / n;
    let corner = |x: i32, z: i32| [(x - n / 2) * step, height(x, z), (z - n / 2) * step];
    (0..n)
        .flat_map(|x| (0..n).map(move |z| (x, z)))
        .flat_map(|(x, z)| {
            let [a, b, c, d] = [corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect()
}

fn root(triangles: &[[[i32; 3]; 3]]) -> Bounds {
    triangles.iter().map(Bounds::of_triangle).reduce(|a, b| a.union(&b)).unwrap().enlarged(1)
}

#[test]
fn a_terrain_of_sixty_thousand_triangles_takes_moments() {
    let triangles = terrain(173);
    let tree = build(&triangles, root(&triangles), Depth::default(), BuildMethod::Report).unwrap();
    assert_eq!(tree.statistics().depth, DEPTH);
    // Every triangle is in every leaf that its box reaches into.
    for node in tree.nodes() {
        if let Content::Leaf { triangles: packet } = node.content {
            assert!(packet.is_sorted());
            for &index in packet {
                let (t, b) = (Bounds::of_triangle(&triangles[index as usize]), &node.bounds);
                assert!((0..3).all(|k| t.low[k] <= b.high[k] && t.high[k] >= b.low[k]));
            }
        }
    }
}

#[test]
fn the_tree_does_not_depend_on_threads() {
    let triangles = terrain(60);
    for method in BuildMethod::ALL {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| build(&triangles, root(&triangles), Depth::Auto, method).unwrap())
        };
        assert_eq!(on(1), on(3), "{method:?}");
    }
}

/// FNV-1a over a tree: the planes and packets of its nodes, in their order.
fn fingerprint(tree: &KdTree) -> u64 {
    let mut words = Vec::new();
    for node in tree.nodes() {
        match node.content {
            Content::Inner { axis, at, left } => words.extend([axis as u32, at as u32, left]),
            Content::Leaf { triangles } => {
                words.push(u32::MAX - triangles.len() as u32);
                words.extend(triangles);
            }
        }
    }
    let octets = words.into_iter().flat_map(u32::to_le_bytes);
    octets.fold(0xcbf2_9ce4_8422_2325, |hash, octet| (hash ^ u64::from(octet)).wrapping_mul(0x0100_0000_01b3))
}

/// Triangles anywhere in a box, of all sizes, some of them flat along an axis.
fn soup(n: u32) -> Vec<[[i32; 3]; 3]> {
    let mut state = 1u32;
    let mut next = move |range: i32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((i64::from(state) * i64::from(range)) >> 32) as i32
    };
    (0..n)
        .map(|number| {
            let middle = [next(1 << 30), next(1 << 30), next(1 << 30)];
            let size = 1 << (10 + number % 19);
            let mut corners = [(); 3].map(|()| [0, 1, 2].map(|k| middle[k] + next(size)));
            if number % 5 == 0 {
                let axis = number as usize / 5 % 3;
                // On one of few planes, so that many bounds are equal.
                corners.iter_mut().for_each(|corner| corner[axis] = middle[axis] >> 24 << 24);
            }
            corners
        })
        .collect()
}

/// A faster way to build a tree builds the same one: pictures, clocks and tables of pages depend on it.
#[test]
fn trees_by_bins_are_the_ones_they_were() {
    let trees = [("terrain", terrain(60)), ("cap", cap(2_000)), ("soup", soup(9_000))].map(|(name, triangles)| {
        let tree = build(&triangles, root(&triangles), Depth::Auto, BuildMethod::Binned).unwrap();
        (name, tree.count(), tree.references(), fingerprint(&tree))
    });
    let expected = [
        ("terrain", 7_265, 7_200, 10_005_375_769_579_950_695),
        ("cap", 9_985, 106_508, 16_119_005_983_124_208_667),
        ("soup", 15_083, 12_397, 9_340_469_628_328_931_871),
    ];
    assert_eq!(trees, expected);
}

#[test]
fn depth_grows_with_the_scene_where_it_is_automatic() {
    let levels = [0, 1, 2, 1000, 60_000, 1_000_000, 1 << 30].map(|n| Depth::Auto.levels(n));
    // 8, 8, 9.3, 20.96, 28.6, 33.9, 47
    assert_eq!(levels, [8, 8, 9, 21, 29, 34, DEEPEST]);
    assert_eq!(Depth::Levels(99).levels(5), DEEPEST);
}

#[test]
fn parts_make_a_better_tree_than_boxes() {
    // A landscape that leans over, so that no triangle fills its box.
    let triangles: Vec<_> =
        terrain(30).iter().map(|t| t.map(|[x, y, z]| [x / 4 + z / 4, y + z / 4, z / 4 - y])).collect();
    let cost = |method| {
        let tree = build(&triangles, root(&triangles), Depth::Levels(12), method).unwrap();
        tree.statistics().expected_cost
    };
    let [boxes, parts, binned] = [BuildMethod::Report, BuildMethod::Exact, BuildMethod::Binned].map(cost);
    assert!(binned < 1.05 * parts, "{binned} by bins, {parts} by all bounds");
    assert!(parts < 0.95 * boxes, "{parts} by parts, {boxes} by boxes");
}

#[test]
fn cheaper_visits_make_more_nodes_and_smaller_leaves() {
    let triangles = terrain(30);
    let tree = |visit| {
        let tree = build_in_order(&triangles, root(&triangles), Depth::Auto, BuildMethod::Binned, visit).unwrap();
        let statistics = tree.by_levels().statistics();
        // Of n nodes (n + 1) / 2 are leaves.
        (statistics.nodes, statistics.references as f64 / statistics.nodes.div_ceil(2) as f64)
    };
    let trees = [VISIT, 50, 25, 6].map(tree);
    for pair in trees.windows(2) {
        assert!(pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1, "{trees:?}");
    }
}

#[test]
fn other_costs_of_visits_are_for_bins_alone() {
    let triangles = terrain(3);
    for method in [BuildMethod::Report, BuildMethod::Exact] {
        let tree = |visit| build_in_order(&triangles, root(&triangles), Depth::Auto, method, visit);
        assert!(tree(VISIT).is_ok());
        let refused = tree(25).map(drop).expect_err("it has no such cost");
        assert_eq!(
            refused.0[0].message,
            format!("visits of nodes cost 25 % of a test, but the kd tree is built by `{}`", method.name())
        );
    }
}

/// A round cap as drawing programs export it: `n` thin triangles around a point of the rim.
fn cap(n: u32) -> Vec<[[i32; 3]; 3]> {
    let corner = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        [(1e9 * angle.cos()) as i32, (1e9 * angle.sin()) as i32, 0]
    };
    (1..n - 1).map(|k| [corner(0), corner(k), corner(k + 1)]).collect()
}

#[test]
fn a_cap_of_thin_triangles_takes_room_in_proportion() {
    let statistics = |n, method| {
        let triangles = cap(n);
        build(&triangles, root(&triangles), Depth::Auto, method).unwrap().statistics()
    };
    for n in [300, 1_000, 3_000, 30_000] {
        let found = statistics(n, BuildMethod::Binned);
        assert!(found.references <= binned::MOST_COPIES * n as usize, "{n}: {found:?}");
        if n <= 1_000 {
            let [boxes, parts] = [BuildMethod::Report, BuildMethod::Exact].map(|method| statistics(n, method));
            assert!(found.expected_cost < 0.3 * boxes.expected_cost, "{n}: {found:?}, by boxes {boxes:?}");
            assert!(found.expected_cost < 1.5 * parts.expected_cost, "{n}: {found:?}, by parts {parts:?}");
        }
    }
}

/// A point of the triangle, by barycentric weights in 64ths, rounded down; it is off by less than a unit.
fn point([a, b, c]: &[[i32; 3]; 3], u: i64, v: i64) -> [i64; 3] {
    [0, 1, 2].map(|k| {
        let [a, b, c] = [a[k], b[k], c[k]].map(i64::from);
        ((64 - u - v) * a + u * b + v * c).div_euclid(64)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn a_leaf_holds_every_triangle_of_which_a_part_is_in_it(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-200..200)), 1..40),
        scale in 0u32..23,
        visit in 1..VISIT,
    ) {
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(|v| v.map(|x| x << scale))).collect();
        let trees = [BuildMethod::Exact, BuildMethod::Binned]
            .map(|method| build(&triangles, root(&triangles), Depth::Levels(10), method).unwrap());
        let cheap = build_in_order(&triangles, root(&triangles), Depth::Levels(10), BuildMethod::Binned, visit);
        let cheap = cheap.unwrap().by_levels();
        for node in trees.iter().chain([&cheap]).flat_map(|tree| tree.nodes()) {
            let Content::Leaf { triangles: packet } = node.content else { continue };
            prop_assert!(packet.is_sorted());
            for (index, triangle) in (0..).zip(&triangles) {
                let is_inside = |p: [i64; 3]| {
                    (0..3).all(|k| i64::from(node.bounds.low[k]) < p[k] && p[k] + 1 < i64::from(node.bounds.high[k]))
                };
                let reaches = (0..=64).flat_map(|u| (0..=64 - u).map(move |v| (u, v)));
                if reaches.map(|(u, v)| point(triangle, u, v)).any(is_inside) {
                    prop_assert!(packet.contains(&index), "{triangle:?} in {:?}", node.bounds);
                }
                // None is there by its box alone: its own box reaches in, too.
                let whole = Bounds::of_triangle(triangle);
                if packet.contains(&index) {
                    prop_assert!((0..3).all(|k| whole.low[k] <= node.bounds.high[k] && whole.high[k] >= node.bounds.low[k]));
                }
            }
        }
    }
}
