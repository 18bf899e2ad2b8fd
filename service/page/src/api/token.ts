// The token comes once, behind the # of a link, which no server is told, or by a sign-in; it stays in this browser.

const kKey = 'touchcal.token';

/** The token in a fragment like "#token=ab12", if there is one. */
export function tokenIn(fragment: string): string | null {
  const token = new URLSearchParams(fragment.replace(/^#/, '')).get('token');
  return token && /^[\x21-\x7e]{1,512}$/.test(token) ? token : null;
}

export function keepToken(token: string): void {
  for (const place of [() => localStorage, () => sessionStorage]) {
    try {
      place().setItem(kKey, token);
      return;
    } catch {
      // This browser does not let pages keep things there.
    }
  }
}

/** As after a sign-out. */
export function dropToken(): void {
  for (const place of [() => localStorage, () => sessionStorage]) {
    try {
      place().removeItem(kKey);
    } catch {
      // as above
    }
  }
}

/** Another page of this browser signed in or out: all its pages have one token. */
export function watchToken(tell: (token: string | null) => void): void {
  addEventListener('storage', ({key, newValue}) => {
    if (key === kKey) tell(newValue);
  });
}

function kept(): string | null {
  for (const place of [() => localStorage, () => sessionStorage]) {
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
