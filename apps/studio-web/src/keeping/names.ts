/** What documents and plants are called that nobody named: after their species, or what a drawing shows. */
import { t, type TextKey, tOf } from '../text';
import type { DocumentState, PlantState, PlantView, SceneView } from '../wire';

/** What the core calls a document and its first plant. */
const UNNAMED = 'plant';

/** As a person named it, else after its species or what is drawn; `seen`: what was made of it. */
export function plantName(plant: PlantState, seen: PlantView | undefined): string {
  if (plant.name !== UNNAMED) return plant.name;
  const species = plant.tree?.preset ?? plant.flower?.preset;
  if (species) return tOf('word', species);
  const kind = plant.sketch?.sketch.read_as ?? seen?.item?.readings?.[0]?.kind;
  if (typeof kind === 'string' && kind !== 'none') return tOf('kind', kind);
  return t(`maker.${plant.maker}` as TextKey);
}

/** As a person named it or its file is called, else after its first plant. */
export function documentName(state: DocumentState | undefined, scene: SceneView | undefined): string {
  if (state && state.name !== UNNAMED) return state.name;
  const [first] = state?.plants ?? [];
  const seen = scene?.plants.find((p) => p.id === first?.id);
  const bare = !first || (first.sketch && (seen?.parts.length ?? 0) === 0);
  return bare ? t('app.untitled') : plantName(first, seen);
}

/** Whether a plant has the name of a species or of its maker, which goes with its species. */
export function isNamedBySpecies(plant: PlantState): boolean {
  const species = plant.tree?.preset ?? plant.flower?.preset;
  const names = [UNNAMED, t(`maker.${plant.maker}` as TextKey), ...(species ? [tOf('word', species)] : [])];
  return names.includes(plant.name);
}
