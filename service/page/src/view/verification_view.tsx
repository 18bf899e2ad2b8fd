import type {Check, Proof, Qualification, TouchedTool, VerdictName, Verification} from '../api/documents.ts';
import {number} from '../model/format.ts';
import type {Say, WordKey} from '../words/words.ts';
import {Scroll} from './scroll.tsx';
import {Symbol} from './symbol.tsx';
import {OuterText, useLanguage, useSay} from './texts.tsx';
import {kVerdictShapes} from './verdict_shapes.ts';

/** What a proof, a check, a qualification or the touches of a tool found: the verdict first, why, then the figures. */
export function VerificationView({verification}: {verification: Verification}) {
  const say = useSay();
  const {accepted, reasons} = verification.verdict;
  const verdict: VerdictName = accepted === null ? 'incomplete' : accepted ? 'accepted' : 'rejected';
  return (
    <>
      <section class={`verdict ${verdict}`} aria-label={say(wordOf(verification))}>
        <p class="word"><Symbol shape={kVerdictShapes[verdict]} />{say(wordOf(verification))}</p>
        <p>{ofWhat(verification, say)}</p>
        {verification.schema === 'touchcal/qualification/1' && verification.no_of_run !== null ? <p><OuterText text={verification.no_of_run} isEnglish /></p> : null}
        {reasons.length > 0 ? <ul>{reasons.map((reason) => <li key={reason}><OuterText text={reason} isEnglish /></li>)}</ul> : null}
      </section>
      <Found verification={verification} />
    </>
  );
}

function ofWhat(verification: Verification, say: Say): string {
  const {of_run: run, touch_count: count} = verification;
  if (verification.schema === 'touchcal/tool/1') return say('toolOf', {tool: verification.tool, run: verification.of_run, count});
  if (verification.schema !== 'touchcal/qualification/1') return say('verifies', {run: verification.of_run, count});
  return say(run === null ? 'qualifiesAlone' : 'qualifies', {probe: verification.probe, run: run ?? '', count});
}

function Found({verification}: {verification: Verification}) {
  if (verification.schema === 'touchcal/qualification/1')
    return verification.scatter.std_um === null ? null : <ProbeFigures qualification={verification} />;
  if (verification.schema === 'touchcal/tool/1') return verification.position_mm === null ? null : <ToolFigures tool={verification} />;
  return verification.rms_mm === null ? null : <Figures verification={verification} />;
}

function wordOf({schema, verdict: {accepted}}: Verification): WordKey {
  if (accepted === null) return 'noVerdict';
  if (schema === 'touchcal/proof/1') return accepted ? 'proved' : 'notProved';
  if (schema === 'touchcal/tool/1') return accepted ? 'toolFound' : 'toolNotFound';
  if (schema === 'touchcal/qualification/1') return accepted ? 'qualified' : 'notQualified';
  return accepted ? 'unchanged' : 'changed';
}

/** A row of the table: what, its figure with the unit, its limit. */
interface Row { key: string; name: string; figure: string; limit: string }

function Figures({verification}: {verification: Proof | Check}) {
  const say = useSay();
  const language = useLanguage();
  const figure = (value: number | null, digits: number, unit: string): string => `${number(value, digits, language)} ${unit}`.trim();
  const rows: Row[] = [
    {key: 'rms', name: say(verification.schema === 'touchcal/proof/1' ? 'verifiedRms' : 'checksResidual'), figure: figure(verification.rms_mm, 3, 'mm'),
      limit: verification.schema === 'touchcal/proof/1' ? figure(verification.rms_max_mm, 3, 'mm') : ''},
    {key: 'p', name: say('verifiedChance'), figure: figure(verification.p, 3, ''), limit: figure(verification.p_min, 3, '')},
    {key: 'noise', name: say('verifiedNoise'), figure: figure(verification.noise_um, 1, 'µm'), limit: ''},
  ];
  if (verification.schema === 'touchcal/check/1') {
    rows.push({key: 'growth', name: say('verifiedGrowth'), figure: figure(verification.growth_ppm, 1, 'ppm'), limit: ''});
    for (const {joint, offset_mrad, std_offset_mrad} of verification.joints)
      rows.push({key: `joint${joint}`, name: say('verifiedJoint', {joint}),
        figure: `${number(offset_mrad, 3, language)} ± ${number(std_offset_mrad, 3, language)} mrad`, limit: ''});
  } else {
    for (const {alternative, power} of verification.power)
      rows.push({key: alternative, name: say('verifiedPower', {what: alternative}),
        figure: figure(power === null ? null : 100 * power, 0, '%'), limit: ''});
  }
  return <FigureTable rows={rows} />;
}

function ToolFigures({tool}: {tool: TouchedTool}) {
  const say = useSay();
  const language = useLanguage();
  const mm = (value: number | null): string => `${number(value, 3, language)} mm`;
  const axis = (value: number, i: number): Row => ({key: `axis${i}`, name: say('toolPosition', {axis: 'xyz'.charAt(i)}),
    figure: `${number(value, 3, language)} ± ${mm(tool.std_position_mm?.[i] ?? null)}`, limit: ''});
  const rows: Row[] = [
    {key: 'box', name: say('toolInBox'), figure: mm(tool.box_rms_mm),
      limit: tool.box_rms_max_mm === null ? say('qualifiedNoLimit') : `≤ ${mm(tool.box_rms_max_mm)}`},
    {key: 'p', name: say('toolChance'), figure: number(tool.p, 3, language), limit: `≥ ${number(tool.p_min, 3, language)}`},
    {key: 'drawing', name: say('toolOffDrawing'), figure: mm(tool.off_drawing_mm), limit: ''},
    ...(tool.position_mm ?? []).map(axis),
    {key: 'rms', name: say('verifiedRms'), figure: mm(tool.rms_mm), limit: ''},
  ];
  return <FigureTable rows={rows} />;
}

function ProbeFigures({qualification}: {qualification: Qualification}) {
  const say = useSay();
  const language = useLanguage();
  const rows = qualification.criteria.map(({name, unit, value, limit, expanded, passed}): Row => {
    const digits = unit === 'mm' ? 4 : 3;
    const shown = (figure: number): string => `${number(figure, digits, language)} ${unit === 'mm' ? unit : ''}`.trim();
    const uncertainty = expanded === null ? '' : ` ± ${number(expanded, digits, language)}`;
    const decision = say(passed ? 'limitHeld' : 'limitMissed');
    return {key: name, name: criterionWords(name, say), figure: `${value === null ? '–' : shown(value)}${uncertainty}`,
      limit: limit === null ? say('qualifiedNoLimit') : `${unit === 'p' ? '≥' : '≤'} ${shown(limit)}: ${decision}`};
  });
  return <FigureTable rows={rows} />;
}

const kCriterionWords: Record<string, WordKey> = {scatter: 'qualifiedScatter', run_out: 'qualifiedRunOut', lobes: 'qualifiedLobes',
  turns: 'qualifiedTurns', stylus: 'qualifiedStylus'};

function criterionWords(name: string, say: Say): string {
  const [, from, to] = /^length_(\d+)_(\d+)$/.exec(name) ?? [];
  if (from !== undefined && to !== undefined) return say('qualifiedLength', {from, to});
  const key = kCriterionWords[name];
  return key === undefined ? name : say(key);
}

function FigureTable({rows}: {rows: Row[]}) {
  const say = useSay();
  return (
    <Scroll label={say('detail')}>
      <table>
        <caption>{say('detail')}</caption>
        <thead><tr>{(['verifiedWhat', 'verifiedFigure', 'verifiedLimit'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr></thead>
        <tbody>
          {rows.map((row) => (
            <tr key={row.key}><th scope="row">{row.name}</th><td class="figure">{row.figure}</td><td class="figure">{row.limit}</td></tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}
