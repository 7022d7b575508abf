// The page: one source of messages, one store, and panels that listen to it.
import "./style.css";
