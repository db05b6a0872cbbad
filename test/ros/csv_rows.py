"""Messages of the node as the rows of the tables that `simulate` writes."""


def state_row(state):
    p, q, v, w = state.pose.position, state.pose.orientation, state.twist.linear, state.twist.angular
    return [state.time, p.x, p.y, q.x, q.y, q.z, q.w, v.x, v.y, w.x, w.y, w.z, state.stage, state.mode, state.region]


def switch_row(event):
    b, a = event.twist_before, event.twist_after
    return [event.index, event.time, {1: "applied", 2: "released", 3: "exchanged"}[event.kind], event.from_region,
            event.to_region, event.position.x, event.position.y, event.impulse.x, event.impulse.y,
            event.angular_impulse.x, event.angular_impulse.y, event.angular_impulse.z,
            b.linear.x, b.linear.y, b.angular.x, b.angular.y, b.angular.z,
            a.linear.x, a.linear.y, a.angular.x, a.angular.y, a.angular.z, event.energy_before, event.energy_after]


def parsed(row):
    """The values of a CSV row; 17 digits give back the double."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return [value(text) for text in row.values()]
