/** How wind moves vertices, here and in the Studio: the shader that docs/exports.md gives to other programs. */

/** Word for word as docs/exports.md has it; a test compares them. */
export const BLOW = `
attribute vec4 _wind;  attribute vec3 _pivot;
uniform float time;    // seconds
uniform vec3 gust;     // metres at the top, such as a tenth of the height: vec3(1.5, 0.0, 0.4)
vec3 blow(vec3 p) {
    float tau = 6.2832;
    p += gust * _wind.x * (0.6 + 0.4 * sin(1.1 * time));             // the whole plant leans and sways
    p += gust * _wind.y * sin(2.3 * time + tau * _wind.w);           // each limb in its own time
    float own = _wind.w + dot(_pivot, vec3(7.1, 5.3, 3.7));          // each leaf in its own time
    vec3 turn = cross(vec3(0.60, 0.64, 0.48), position - _pivot);    // about the point where it is fixed
    return p + turn * 0.25 * _wind.z * sin(9.0 * time + tau * own);
}
`;
