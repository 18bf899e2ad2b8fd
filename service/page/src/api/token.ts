// The token comes once, behind the # of a link, which no server is told, or by a sign-in; it stays in this browser.

const kKey = 'touchcal.token';

/** The token in a fragment like "#token=ab12", if there is one. */
export function tokenIn(fragment: string): string | null {
  const token = new URLSearchParams(fragment.replace(/^#/, '')).get('token');
  return token && /^[\x21-\x7e]{1,512}$/.test(token) ? token : null;
}

const kPlaces = [() => localStorage, () => sessionStorage];

function forgetIn(place: () => Storage): void {
  try {
    place().removeItem(kKey);
  } catch {
    // This browser does not let pages keep things there.
  }
}

/**
 * In the first place that takes it. In no other an old one is left, which would be read in its stead: not in one that is full
 * either. Where no place takes it, the page itself goes on with it until it is loaded anew.
 */
export function keepToken(token: string): void {
  let isKept = false;
  for (const place of kPlaces) {
    if (!isKept && keepIn(place, token)) {
      isKept = true;
      continue;
    }
    forgetIn(place);
    // Without the old one there may be room: the other pages of this browser, which hear of the removal, then get the new one.
    if (!isKept) isKept = keepIn(place, token);
  }
}

function keepIn(place: () => Storage, token: string): boolean {
  try {
    place().setItem(kKey, token);
    return true;
  } catch {
    return false;  // full, or as above
  }
}

/** As after a sign-out. */
export function dropToken(): void {
  kPlaces.forEach(forgetIn);
}

/** Another page of this browser signed in or out: all its pages have one token. */
export function watchToken(tell: (token: string | null) => void): void {
  addEventListener('storage', ({key, newValue}) => {
    if (key === kKey) tell(newValue);
  });
}

function kept(): string | null {
  for (const place of kPlaces) {
    try {
      const token = place().getItem(kKey);
      if (token) return token;
    } catch {
      // as above
    }
  }
  return null;
}

/** The token of this browser; one that stands in the address is kept and taken out of it. */
export function takeToken(): string | null {
  const brought = tokenIn(location.hash);
  if (!brought) return kept();
  keepToken(brought);
  history.replaceState(null, '', location.pathname + location.search);
  return brought;
}
