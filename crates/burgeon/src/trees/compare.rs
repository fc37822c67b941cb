//! One oak by three methods, as Yang et al. (2019) compare them in its Table 2.

use base::ops;
use growth::{Grown, GuidedSpec, Light, Method, Resource, SelfOrganizingSpec};

/// Method and preset of each oak, in the paper's order.
pub const OAK_METHODS: [(&str, &str); 3] =
    [("L-system", "oak-lsystem"), ("space colonization", "oak-colonization"), ("space competition", "oak")];

/// Names of the methods that [`guided_methods`] compares.
pub const GUIDED_METHODS: [&str; 2] = ["guided growth", "self-organisation"];

/// Returns the settings of one crown by the improved growth of the VR paper and by its baseline, space colonisation by
/// buds (Palubicki et al. 2009): in one envelope, with internodes of one length, one perception, angle, phyllotaxis,
/// bias and number of rounds.
///
/// `None` where the method has no envelope. The baseline's markers are as dense as a bud's own in its perception cone.
pub fn guided_methods(method: &Method) -> Option<[Method; 2]> {
    let envelope = match method {
        Method::Competition(s) => s.envelope.whole(),
        Method::Colonization { envelope, .. } => envelope.whole(),
        _ => return None,
    };
    let guided = GuidedSpec::from_crown(envelope.clone());
    let (lo, hi) = envelope.prepare().ok()?.bounds();
    // A cone of half opening a between two radii holds 2 pi / 3 (1 - cos a)(R^3 - r^3).
    let reach = guided.internode_m * guided.far;
    let near = guided.internode_m * guided.near;
    let open = 1.0 - ops::cos(guided.half_angle_deg * (ops::PI / 180.0));
    let cone = 2.0 * ops::PI / 3.0 * open * (reach * reach * reach - near * near * near);
    let size = hi - lo;
    // Half of a box is crown, roughly.
    let markers = (0.5 * size.x * size.y * size.z * f64::from(guided.markers) / cone).clamp(1e3, 1e6);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a thousand to a million")]
    let light = Light::Space {
        envelope,
        markers: markers as u32,
        occupancy: guided.near,
        perception: guided.far,
        half_angle_deg: guided.half_angle_deg,
    };
    let baseline = SelfOrganizingSpec {
        years: guided.rounds,
        internode_m: guided.internode_m,
        light,
        resource: Resource::BorchertHonda { lambda: guided.lambda, lambda_late: None },
        alpha: guided.alpha,
        tropisms: guided.tropisms.clone(),
        arrangement: guided.arrangement,
        branch_angle_deg: guided.branch_angle_deg,
        jitter_deg: guided.jitter_deg,
        most_per_shoot: guided.most_per_shoot,
        light_weight: 1.0,
        // No shedding: a full crown has no free marker left, and would be shed whole.
        shed_below: 0.0,
        ..SelfOrganizingSpec::default()
    };
    Some([Method::Guided(guided), Method::SelfOrganizing(baseline)])
}

/// A row of the paper's table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperOak {
    /// Method.
    pub method: &'static str,
    /// Vertices, thousands.
    pub vertices_k: f64,
    /// Triangles, thousands.
    pub triangles_k: f64,
    /// Seconds.
    pub seconds: f64,
}

/// Yang et al. (2019), Table 2.
pub const PAPER_OAKS: [PaperOak; 3] = [
    PaperOak { method: "L-system", vertices_k: 601.0, triangles_k: 635.6, seconds: 45.0 },
    PaperOak { method: "space colonization", vertices_k: 117.8, triangles_k: 147.2, seconds: 8.0 },
    PaperOak { method: "space competition", vertices_k: 105.2, triangles_k: 122.1, seconds: 9.0 },
];

/// Size of a tree, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeSize {
    /// Height from the ground to the highest node.
    pub height_m: f64,
    /// Mean of the crown's extents along x and z.
    pub crown_m: f64,
}

/// Measures the wood of a tree.
pub fn tree_size(grown: &Grown) -> TreeSize {
    let mut bounds = mesh::Bounds::EMPTY;
    grown.plant.nodes.position.iter().for_each(|p| bounds.include(*p));
    let size = bounds.size();
    let height_m = if bounds.is_empty() { 0.0 } else { bounds.max.y };
    TreeSize { height_m, crown_m: 0.5 * (size.x + size.z) }
}

/// Scales a whole tree about its root until it is `height_m` high, above 0; leaves keep their size.
///
/// The tree stays as it is where it has no height.
pub fn scale_to_height(grown: &mut Grown, height_m: f64) {
    let now = tree_size(grown).height_m;
    let factor = height_m / now;
    if !(now > 1e-9 && factor.is_finite() && factor > 0.0) {
        return;
    }
    let plant = &mut grown.plant;
    plant.nodes.position.iter_mut().for_each(|p| *p *= factor);
    plant.nodes.radius_m.iter_mut().for_each(|r| *r *= factor);
    plant.organs.iter_mut().for_each(|o| o.frame.origin *= factor);
    plant.flowers.iter_mut().for_each(|f| f.centre *= factor);
}
