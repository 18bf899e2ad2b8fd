import {headersOf} from './client.ts';

/** Saves what the page has as a file. */
export function saveBlob(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  URL.revokeObjectURL(address);
}

/** Saves a document of the daemon as a file; false when it was not given. A link could not carry the token. */
export async function saveAs(path: string, name: string, token: string | null): Promise<boolean> {
  try {
    const response = await fetch(path, {headers: headersOf({token}), cache: 'no-store'});
    if (!response.ok) return false;
    saveBlob(await response.blob(), name);
    return true;
  } catch {
    return false;
  }
}
