/** Light through thin blades. */
import type * as Three from 'three';

/** Each light also comes from behind a surface, and takes the colour of the surface on its way. What comes through is not
 * thrown back: as in `KHR_materials_diffuse_transmission`, with the share `uThrough`. Nothing is lit where no light is. */
const BLADE = `
uniform float uThrough;
void RE_Direct_Blade(
  const in IncidentLight light, const in vec3 place, const in vec3 normal, const in vec3 view, const in vec3 coat,
  const in PhysicalMaterial surface, inout ReflectedLight seen
) {
  vec3 before = seen.directDiffuse;
  RE_Direct_Physical(light, place, normal, view, coat, surface, seen);
  vec3 behind = saturate(-dot(normal, light.direction)) * light.color * BRDF_Lambert(surface.diffuseColor);
  seen.directDiffuse = before + mix(seen.directDiffuse - before, behind, uThrough);
}
#undef RE_Direct
#define RE_Direct RE_Direct_Blade
`;

const LIGHTS = '#include <lights_physical_pars_fragment>';

/** Lets this share of the light, 0 to 1, through whatever is drawn with a material. */
export function lit<M extends Three.Material>(material: M, share: number): M {
  const [before, key] = [material.onBeforeCompile.bind(material), material.customProgramCacheKey()];
  material.onBeforeCompile = (program, renderer) => {
    before(program, renderer);
    program.uniforms['uThrough'] = { value: share };
    program.fragmentShader = program.fragmentShader.replace(LIGHTS, `${LIGHTS}\n${BLADE}`);
  };
  material.customProgramCacheKey = () => `${key}-through`;
  return material;
}
