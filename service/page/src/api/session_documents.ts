// The API's documents about persons and their sessions.

/** What a person may do; each may what the one before may. */
export type PersonRole = 'view' | 'operate' | 'engineer';
export const kPersonRoles: readonly PersonRole[] = ['view', 'operate', 'engineer'];

/** Whom a token stands for. A session that has run out: kind 'user', role 'none', its name. */
export interface Session {
  schema: 'touchcal/session/1';
  name: string | null;
  role: 'none' | PersonRole;
  kind: 'none' | 'token' | 'user';  // token: of a file of the state directory
  ends_at: string | null;
  sign_in: boolean;                 // there are persons who may sign in
}

export interface SignedIn { schema: 'touchcal/signed-in/1'; token: string; name: string; role: PersonRole; ends_at: string }

export interface Person {
  name: string;
  role: PersonRole;
  created_at: string;
  created_by: string | null;
  last_sign_in_at: string | null;
  session_count: number;
}
export interface People { schema: 'touchcal/users/1'; users: Person[] }
