import type {VNode} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import type {Reply} from '../api/client.ts';
import type {Fleet, FleetCell, FleetTrend, FleetTrends} from '../api/fleet_documents.ts';
import type {Desk} from '../model/desk.ts';
import {kUnknown, number, roundedUp, time} from '../model/format.ts';
import {faultTitle, hasTitle} from '../words/fault_words.ts';
import {kFleetWords, type FleetWordKey} from '../words/fleet_words.ts';
import {sayName} from '../words/words.ts';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';

const kShownOfHash = 12;

const useFleetSay = (): ((key: FleetWordKey) => string) => {
  const language = useLanguage();
  return (key) => kFleetWords[language][key];
};

/** All cells that the archive lets this cell read, and what those with arms of one type told by month. */
export function FleetView({desk}: {desk: Desk}) {
  const sayPage = useSay();
  const say = useFleetSay();
  const [told, setTold] = useState<[Reply<Fleet>, Reply<FleetTrends>] | null>(null);
  const ask = (): void => {
    setTold(null);
    void desk.askFleet().then(setTold);
  };
  useEffect(ask, []);
  if (!told) return <p role="status">{sayPage('loading')}</p>;
  const [cells, trends] = told;
  return (
    <>
      <Told reply={cells} show={(fleet) => <Cells cells={fleet.cells} />} />
      {cells.kind === 'ok' ? <Told reply={trends} show={(fleet) => <Trends trends={fleet.trends} />} /> : null}
      <button type="button" onClick={ask}>{say('again')}</button>
    </>
  );
}

function Told<T>({reply, show}: {reply: Reply<T>; show: (value: T) => VNode}) {
  const sayPage = useSay();
  const say = useFleetSay();
  if (reply.kind === 'ok') return show(reply.value);
  const why = reply.kind === 'refused' ? <>{say('refused')} <OuterText text={reply.problem.detail} isEnglish /></> : sayPage('noAnswer');
  return <p class="abnormal" role="status"><Symbol shape="warning" />{why}</p>;
}

function Cells({cells}: {cells: FleetCell[]}) {
  const sayPage = useSay();
  const say = useFleetSay();
  if (cells.length === 0) return <p class="empty">{say('empty')}</p>;
  const columns = ['cell', 'state', 'arm', 'heard', 'run', 'model', 'tip', 'valid', 'inUse', 'check', 'due', 'proof', 'certificate', 'fault'] as const;
  return (
    <Scroll label={sayPage('fleet')}>
      <table>
        <thead><tr>{columns.map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr></thead>
        <tbody>{cells.map((cell) => <CellRow key={cell.cell} cell={cell} />)}</tbody>
      </table>
    </Scroll>
  );
}

function CellRow({cell}: {cell: FleetCell}) {
  const say = useFleetSay();
  const language = useLanguage();
  const outer = (text: string | null) => (text === null ? <>{kUnknown}</> : <OuterText text={text} />);
  const verdict = (name: string | null): string => (name === null ? kUnknown : sayName(language, 'verdict_', name));
  const isOther = cell.applied_model !== null && cell.applied_model !== cell.model;
  return (
    <tr>
      <th scope="row"><OuterText text={cell.cell} /></th>
      <td>{cell.state === null ? kUnknown : say(`state_${cell.state}`)}</td>
      <td>{outer(cell.arm)}{cell.arm_serial === null ? null : <>, <OuterText text={cell.arm_serial} /></>}</td>
      <td>{time(cell.heard_at)}</td>
      <td class={cell.verdict === 'rejected' ? 'abnormal' : ''}>{cell.outcome === null || cell.outcome === 'complete' ? verdict(cell.verdict) : sayName(language, 'outcome_', cell.outcome)}, {time(cell.ended_at)}</td>
      <td>{cell.model?.slice(0, kShownOfHash) ?? kUnknown}</td>
      <td class="figure">{cell.tip_box_max_mm === null ? kUnknown : roundedUp(cell.tip_box_max_mm, language)}</td>
      <Due at={cell.valid_until} isOver={cell.model_over} />
      <td class={isOther ? 'abnormal' : ''}>
        {isOther ? <Symbol shape="warning" /> : null}
        {cell.applied_model === null ? kUnknown : isOther ? cell.applied_model.slice(0, kShownOfHash) : say('same')}
        {cell.applied_to === null ? null : <>: <OuterText text={cell.applied_to} /></>}
      </td>
      <td class={cell.last_check_verdict === 'rejected' ? 'abnormal' : ''}>
        {cell.last_check_verdict === 'rejected' ? <Symbol shape="warning" /> : null}{verdict(cell.last_check_verdict)}, {time(cell.last_check_at)}
      </td>
      <Due at={cell.check_due_at} isOver={cell.check_overdue} />
      <td class={cell.last_proof_verdict === 'rejected' ? 'abnormal' : ''}>
        {cell.last_proof_verdict === 'rejected' ? <Symbol shape="warning" /> : null}{verdict(cell.last_proof_verdict)}, {time(cell.last_proof_at)}
      </td>
      <td class={cell.certificate_over ? 'abnormal' : undefined}>
        {cell.certificate_over && <Symbol shape="warning" />}{outer(cell.certificate_artefact)}
        {cell.certificate_valid_until === null ? null : <>, <OuterText text={cell.certificate_valid_until} /></>}{cell.certificate_over && <>, {say('over')}</>}
      </td>
      <td>
        {cell.last_fault_code === null ? kUnknown
          : hasTitle(language, cell.last_fault_code) ? faultTitle(language, cell.last_fault_code) : <OuterText text={cell.last_fault_code} isEnglish />}
        {cell.last_fault_at === null ? null : `, ${time(cell.last_fault_at)}`}
      </td>
    </tr>
  );
}

/** A time that is over by the archive's clock is marked. */
function Due({at, isOver}: {at: string | null; isOver: boolean}) {
  const say = useFleetSay();
  if (!isOver) return <td>{time(at)}</td>;
  return <td class="abnormal"><Symbol shape="warning" />{time(at)}, {say('over')}</td>;
}

function Trends({trends}: {trends: FleetTrend[]}) {
  const say = useFleetSay();
  const language = useLanguage();
  if (trends.length === 0) return null;
  const columns = ['month', 'arm', 'cells', 'calibrations', 'approved', 'checks', 'growth', 'proofs', 'faults'] as const;
  return (
    <>
      <h3>{say('trends')}</h3>
      <Scroll label={say('trends')}>
        <table>
          <thead><tr>{columns.map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr></thead>
          <tbody>
            {trends.map((trend) => (
              <tr key={`${trend.month} ${trend.arm}`}>
                <th scope="row">{trend.month}</th>
                <td>{trend.arm === null ? kUnknown : <OuterText text={trend.arm} />}</td>
                <td class="figure">{trend.cells}</td>
                <td class="figure">{trend.calibrations}, {trend.rejected}</td>
                <td class="figure">{trend.approved}, {number(trend.tip_box_max_mm, 3, language)}</td>
                <td class="figure">{trend.checks}, {trend.alarms}</td>
                <td class="figure">{number(trend.growth_ppm, 1, language)}</td>
                <td class="figure">{trend.proofs}, {trend.failed_proofs}</td>
                <td class="figure">{trend.faults}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
      <p class="hint">{say('median')}</p>
    </>
  );
}
