import type {UncertaintyMap} from '../api/documents.ts';
import {number} from '../model/format.ts';
import {layersOf, rangeOf, type Layer} from '../model/map_layers.ts';
import {useLanguage, useSay} from './texts.tsx';

const kCell = 20;

/** The predicted tip error over the workspace box, a picture a layer: darker is worse. */
export function UncertaintyMapView({map}: {map: UncertaintyMap}) {
  const say = useSay();
  const language = useLanguage();
  const range = rangeOf(map);
  if (!range) return null;
  const [low, high] = range;
  return (
    <section class="map">
      <h3>{say('map')}</h3>
      <p>{say('mapScale', {low: number(low, 3, language), high: number(high, 3, language)})} <Legend low={low} high={high} /></p>
      <div class="layers">
        {layersOf(map).map((layer) => <LayerView key={layer.y_mm} layer={layer} low={low} high={high} />)}
      </div>
    </section>
  );
}

/** 0 to 4: a step of the grey scale. */
const step = (value: number, low: number, high: number): number =>
    high > low ? Math.min(4, Math.floor((5 * (value - low)) / (high - low))) : 0;

function Legend({low, high}: {low: number; high: number}) {
  return (
    <svg viewBox={`0 0 ${5 * kCell} ${kCell}`} width="100" height="16" aria-hidden="true">
      {[0, 1, 2, 3, 4].map((i) => (
        <rect key={i} class={`shade${step(low + ((i + 0.5) / 5) * (high - low), low, high)}`} x={i * kCell} y="0" width={kCell} height={kCell} />
      ))}
    </svg>
  );
}

function LayerView({layer, low, high}: {layer: Layer; low: number; high: number}) {
  const say = useSay();
  const language = useLanguage();
  const columns = layer.rows[0]?.length ?? 0;
  const known = layer.rows.flat().filter((value): value is number => value !== null);
  const worst = known.length > 0 ? `${number(Math.max(...known), 3, language)} mm` : say('mapUnreachable');
  const title = say('mapHeight', {y: number(layer.y_mm, 0, language)});
  return (
    <figure>
      <svg viewBox={`0 0 ${columns * kCell} ${layer.rows.length * kCell}`} role="img" aria-label={`${title}: ${worst}`}>
        {layer.rows.map((row, z) => row.map((value, x) => (
          <rect key={`${x} ${z}`} class={value === null ? 'unreachable' : `shade${step(value, low, high)}`} x={x * kCell} y={z * kCell}
                width={kCell} height={kCell}>
            <title>{value === null ? say('mapUnreachable') : `${number(value, 3, language)} mm`}</title>
          </rect>
        )))}
      </svg>
      <figcaption>{title}</figcaption>
    </figure>
  );
}
