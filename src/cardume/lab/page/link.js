// The line to the laboratory: JSON both ways, and what is known of its end.
const LARGEST = 900_000; // bytes of a message; more would end the line

export const openLink = ({ told, lost, back, tooLarge }) => {
  let socket = null;
  const address = `ws://${location.host}${location.pathname}line`;
  const connect = () => {
    socket = new WebSocket(address);
    socket.onopen = back;
    socket.onmessage = (event) => told(JSON.parse(event.data));
    socket.onclose = () => {
      lost("gone");
      setTimeout(look, 300);
    };
  };
  // A line that cannot be opened does not say why; a page that cannot be loaded does.
  const look = async () => {
    try {
      const answer = await fetch(location.href, { cache: "no-store" });
      if (answer.ok) return connect();
      lost("other");
    } catch {
      lost("gone");
    }
    setTimeout(look, 2000);
  };
  connect();
  const say = (message) => {
    const text = JSON.stringify(message);
    if (new Blob([text]).size > LARGEST) tooLarge();
    else if (socket.readyState === WebSocket.OPEN) socket.send(text);
  };
  return { say };
};
