//! Handles of rows.

base::define_id! {
    /// One axis: a trunk, branch, twig, stem, stalk or root.
    pub struct AxisId;
}
base::define_id! {
    /// One node: a point of an axis that may bear other parts.
    pub struct NodeId;
}
base::define_id! {
    /// One organ.
    pub struct OrganId;
}
base::define_id! {
    /// One shape, which organs may share.
    pub struct ShapeId;
}
base::define_id! {
    /// One flower.
    pub struct FlowerId;
}
