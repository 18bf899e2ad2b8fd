import type {Cell, Result} from '../api/documents.ts';
import {faceLabel} from '../model/faces.ts';
import {number} from '../model/format.ts';
import {residualsOf, type Residual} from '../model/live_figures.ts';
import {whereByResult} from '../model/places.ts';
import {Symbol} from './symbol.tsx';
import {useLanguage, useSay} from './texts.tsx';

const kWidth = 200;

/** The touches' distances from their planes against the cell's limits, a row a plane. */
export function Residuals({result, cell}: {result: Result; cell: Cell}) {
  const say = useSay();
  const language = useLanguage();
  const {held_out_mean_max_mm: mean_max, held_out_rms_max_mm: rms_max} = cell.acceptance;
  const whereOf = whereByResult(result);
  return (
    <table class="residuals">
      <caption>
        {say('residuals', {mean: number(mean_max, 3, language), rms: number(rms_max, 3, language)})}
      </caption>
      <thead>
        <tr>
          <th scope="col">{say('plane', {plane: ''})}</th>
          <th scope="col" colSpan={2}>{say('residualsFit')}</th>
          <th scope="col" colSpan={2}>{say('residualsHeld')}</th>
        </tr>
      </thead>
      <tbody>
        {residualsOf(result, cell).map(({plane, fit, held_out}) => (
          <tr key={plane}>
            <th scope="row">{faceLabel(cell, plane, say, whereOf)}</th>
            <Cells residual={fit} limit={rms_max} />
            <Cells residual={held_out} limit={rms_max} />
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Cells({residual, limit}: {residual: Residual | null; limit: number}) {
  const say = useSay();
  const language = useLanguage();
  if (!residual) return <td colSpan={2} />;
  return (
    <>
      <td><Bar residual={residual} limit={limit} /></td>
      <td class={residual.isWithin ? 'figure' : 'figure abnormal'}>
        {residual.isWithin ? null : <Symbol shape="warning" />}
        {number(residual.rms_mm, 3, language)}
        <span class="visually-hidden"> {say(residual.isWithin ? 'limitHeld' : 'limitMissed')}</span>
      </td>
    </>
  );
}

/** rms as a bar, the mean as a stroke, the limit as a line at two thirds. */
function Bar({residual, limit}: {residual: Residual; limit: number}) {
  const place = (value_mm: number): number => Math.min(kWidth, (Math.abs(value_mm) / limit) * kWidth * (2 / 3));
  return (
    <svg viewBox={`0 0 ${kWidth} 14`} preserveAspectRatio="none" class={residual.isWithin ? 'bar' : 'bar beyond'} aria-hidden="true">
      <rect class="ground" x="0" y="3" width={kWidth} height="8" />
      <rect class="value" x="0" y="3" width={place(residual.rms_mm)} height="8" />
      <path class="mean" d={`M${place(residual.mean_mm)} 1v12`} />
      <path class="limit" d={`M${kWidth * (2 / 3)} 0v14`} />
    </svg>
  );
}
