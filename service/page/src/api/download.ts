import {headersOf} from './client.ts';

/** Saves a document of the daemon as a file; false when it was not given. A link could not carry the token. */
export async function saveAs(path: string, name: string, token: string | null): Promise<boolean> {
  try {
    const response = await fetch(path, {headers: headersOf({token}), cache: 'no-store'});
    if (!response.ok) return false;
    const address = URL.createObjectURL(await response.blob());
    const link = document.createElement('a');
    link.href = address;
    link.download = name;
    link.click();
    URL.revokeObjectURL(address);
    return true;
  } catch {
    return false;
  }
}
