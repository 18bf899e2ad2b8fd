import {useEffect, useState} from 'preact/hooks';
import {kPersonRoles, type Person, type PersonRole} from '../api/session_documents.ts';
import {kUnknown, time} from '../model/format.ts';
import type {PageState} from '../model/page_state.ts';
import type {Outcome, Pass} from '../model/pass.ts';
import {Scroll} from './scroll.tsx';
import {kSecretMin, SecretChoices, SecretField, useSecretEntry} from './secret_field.tsx';
import {NotDone} from './sign_in_form.tsx';
import {useSay} from './texts.tsx';

/** Who may sign in: for an engineer. */
export function PeoplePanel({state, pass}: {state: PageState; pass: Pass}) {
  const say = useSay();
  const [edited, setEdited] = useState<Person | 'new' | null>(null);
  const [outcome, setOutcome] = useState<Outcome | null>(null);
  useEffect(() => {
    void pass.loadPeople().then(setOutcome);
  }, [pass]);
  const {people} = state;
  return (
    <div class="people">
      <h3>{say('people')}</h3>
      <NotDone outcome={people ? null : outcome} />
      {people && people.length > 0 ? <PeopleTable people={people} onEdit={setEdited} /> : null}
      {people?.length === 0 ? <p>{say('peopleNone')}</p> : null}
      {edited === null && people
        ? <button type="button" onClick={() => setEdited('new')}>{say('personAdd')}</button>
        : null}
      {edited !== null ? <PersonForm key={edited === 'new' ? '' : edited.name} person={edited} pass={pass} onClose={() => setEdited(null)} /> : null}
    </div>
  );
}

function PeopleTable({people, onEdit}: {people: Person[]; onEdit: (person: Person) => void}) {
  const say = useSay();
  return (
    <Scroll label={say('people')}>
      <table>
        <thead>
          <tr>{(['personName', 'personRole', 'personLast', 'personSessions', 'personChange'] as const).map((key) => <th key={key} scope="col">{say(key)}</th>)}</tr>
        </thead>
        <tbody>
          {people.map((person) => (
            <tr key={person.name}>
              <th scope="row" class="outer"><bdi>{person.name}</bdi></th>
              <td>{say(`role_${person.role}`)}</td>
              <td>{person.last_sign_in_at === null ? kUnknown : time(person.last_sign_in_at)}</td>
              <td class="figure">{person.session_count}</td>
              <td>
                <button type="button" onClick={() => onEdit(person)}>
                  {say('personChange')}<span class="visually-hidden"> <bdi>{person.name}</bdi></span>
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

/** A new person, or another role or secret of one. */
function PersonForm({person, pass, onClose}: {person: Person | 'new'; pass: Pass; onClose: () => void}) {
  const say = useSay();
  const isNew = person === 'new';
  const [name, setName] = useState(isNew ? '' : person.name);
  const [role, setRole] = useState<PersonRole>(isNew ? 'operate' : person.role);
  const [secret, setSecret] = useState('');
  const [entry, setEntry] = useSecretEntry();
  const [outcome, setOutcome] = useState<Outcome | null>(null);
  const cannot = !name.trim() || (isNew || secret ? secret.length < kSecretMin : role === (person as Person).role);
  const save = async (): Promise<void> => {
    if (cannot) return;
    const came = await pass.putPerson(name.trim(), role, secret);
    if (came.kind === 'done') onClose();
    else setOutcome(came);
  };
  return (
    <form class="sign-in" aria-labelledby="person" onSubmit={(event) => {
      event.preventDefault();
      void save();
    }}>
      <h3 id="person" class="outer">{isNew ? say('personAdd') : <>{say('personChange')}: <bdi>{person.name}</bdi></>}</h3>
      {isNew ? (
        <label>
          <span>{say('personName')}</span>
          <input type="text" dir="auto" maxLength={64} value={name} autocomplete="off" autocapitalize="none" spellcheck={false} enterkeyhint="next"
                 onInput={(event) => setName(event.currentTarget.value)} />
        </label>
      ) : null}
      <RoleChoice role={role} onRole={setRole} />
      <SecretField label={say(isNew ? 'secret' : 'secretNewOptional')} value={secret} entry={entry} isNew onInput={setSecret} />
      <SecretChoices entry={entry} onEntry={setEntry} />
      <p class="hint">{say('secretRule', {count: kSecretMin})}{isNew ? '' : ` ${say('personSessionsEnd')}`}</p>
      <div role="alert"><NotDone outcome={outcome} /></div>
      <div class="actions">
        <button type="submit" disabled={cannot}>{say('save')}</button>
        <button type="button" onClick={onClose}>{say('cancel')}</button>
      </div>
      {isNew ? null : <Removal name={person.name} pass={pass} onDone={onClose} onFailed={setOutcome} />}
    </form>
  );
}

function RoleChoice({role, onRole}: {role: PersonRole; onRole: (role: PersonRole) => void}) {
  const say = useSay();
  return (
    <>
      <label>
        <span>{say('personRole')}</span>
        <select value={role} onChange={(event) => onRole(kPersonRoles.find((one) => one === event.currentTarget.value) ?? role)}>
          {kPersonRoles.map((one) => <option key={one} value={one}>{say(`role_${one}`)}</option>)}
        </select>
      </label>
      <p class="hint">{say(`roleWords_${role}`)}</p>
    </>
  );
}

/** Asked twice: nothing brings a removed person back but being added anew. */
function Removal({name, pass, onDone, onFailed}: {name: string; pass: Pass; onDone: () => void; onFailed: (outcome: Outcome) => void}) {
  const say = useSay();
  const [isAsked, setAsked] = useState(false);
  if (!isAsked) return <button type="button" onClick={() => setAsked(true)}>{say('personRemove')}…</button>;
  const remove = async (): Promise<void> => {
    const came = await pass.removePerson(name);
    if (came.kind === 'done') onDone();
    else onFailed(came);
  };
  return (
    <div class="card warning" role="alertdialog" aria-labelledby="removal">
      <p id="removal" class="outer"><bdi><strong>{name}</strong></bdi>: {say('personRemoveAsk')}</p>
      <div class="actions">
        <button type="button" onClick={() => void remove()}>{say('personRemove')}</button>
        <button type="button" onClick={() => setAsked(false)}>{say('cancel')}</button>
      </div>
    </div>
  );
}
