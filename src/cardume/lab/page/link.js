// The line to the laboratory: JSON both ways, and what is known of its end.
export const openLink = ({ told, lost, back }) => {
  let socket = null;
  const address = `ws://${location.host}${location.pathname}line`;
  const connect = () => {
    socket = new WebSocket(address);
    socket.onopen = back;
    socket.onmessage = (event) => told(JSON.parse(event.data));
    socket.onclose = (event) => {
      lost(event.code === 1009 ? "tooLarge" : "gone");
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
  return { say: (message) => socket.readyState === WebSocket.OPEN && socket.send(JSON.stringify(message)) };
};
