/** One server-sent event. */
export interface StreamEvent { event: string; id: string; data: string }

/** Takes the text of an event stream in pieces as they come; gives the events that are whole. */
export class EventText {
  private rest = '';

  push(text: string): StreamEvent[] {
    this.rest += text;
    const events: StreamEvent[] = [];
    for (let end = this.rest.indexOf('\n\n'); end >= 0; end = this.rest.indexOf('\n\n')) {
      const event = parse(this.rest.slice(0, end));
      this.rest = this.rest.slice(end + 2);
      if (event) events.push(event);
    }
    return events;
  }
}

function parse(block: string): StreamEvent | null {
  const event: StreamEvent = {event: 'message', id: '', data: ''};
  const data: string[] = [];
  for (const line of block.split('\n')) {
    const colon = line.indexOf(':');
    if (colon === 0) continue;  // a comment keeps the connection alive
    const name = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '');
    if (name === 'event') event.event = value;
    if (name === 'id') event.id = value;
    if (name === 'data') data.push(value);
  }
  event.data = data.join('\n');
  return data.length > 0 ? event : null;
}
