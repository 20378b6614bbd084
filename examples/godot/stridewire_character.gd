# Drives a Skeleton3D of Godot 4 from a Stridewire server, without an add-on.
#
# Untested: no Godot 4 was at hand where this was written.
#
#   1. stridewire serve --websocket 127.0.0.1:8080
#   2. stridewire stream --seconds 1 --out character.glb     (or any rig with the same joint names)
#   3. In a new project import character.glb; instance it in a scene; right-click, Editable Children.
#   4. Attach this script to its Skeleton3D. Run; WASD or the arrows move it.
#
# Messages are read by the layout that the server tells at /v1/layout.json: the tags of the fields.
# Stridewire's axes are glTF's: right-handed, +Y up, metres. A GLB keeps them in Godot, so that
# positions and rotations go over as they are; only quaternions are w, x, y, z there, x, y, z, w here.
extends Skeleton3D

@export var host := "127.0.0.1:8080"
@export var walk := 1.4
@export var run := 3.2

var socket := WebSocketPeer.new()
var layout: Dictionary
var bones: PackedInt32Array
var step := 0
var last_frame := 0
var opened := false


func _ready() -> void:
	var http := HTTPRequest.new()
	add_child(http)
	http.request("http://%s/v1/layout.json" % host)
	var answer: Array = await http.request_completed  # result, code, headers, body
	layout = JSON.parse_string(answer[3].get_string_from_utf8())
	socket.inbound_buffer_size = 1 << 20
	socket.connect_to_url("ws://%s/v1/animate" % host)


func _process(_delta: float) -> void:
	if layout.is_empty():
		return
	socket.poll()
	if socket.get_ready_state() != WebSocketPeer.STATE_OPEN:
		return
	if not opened:
		opened = true
		send({"open": {"characters": [{"id": 1}], "pacing": 2}})  # PACING_SERVER: 60 frames a second
	while socket.get_available_packet_count() > 0:
		receive(decode("AnimateResponse", socket.get_packet()))
	var way := Input.get_vector("ui_right", "ui_left", "ui_down", "ui_up")  # +X is the left
	var speed := run if Input.is_key_pressed(KEY_SHIFT) else walk
	step += 1
	send({"step": {"step": step, "last_frame": last_frame, "velocity_xz": [speed * way.x, speed * way.y]}})


func receive(message: Dictionary) -> void:
	if message.has("error"):
		push_error(JSON.stringify(message.error))
	if message.has("opened"):
		var names: Array = message.opened.skeleton.joints
		bones = PackedInt32Array(names.map(func(joint: String) -> int: return find_bone(joint)))
	if message.has("frame") and not bones.is_empty():
		last_frame = message.frame.frame
		show_pose(message.frame)


# The root moves the node, the hips and the rotations move the bones.
func show_pose(frame: Dictionary) -> void:
	var root: PackedFloat32Array = frame.root
	var hips: PackedFloat32Array = frame.hips
	var turns: PackedFloat32Array = frame.rotations
	global_position = Vector3(root[0], root[1], root[2])
	quaternion = Quaternion(root[4], root[5], root[6], root[3])
	set_bone_pose_position(bones[0], Vector3(hips[0], hips[1], hips[2]))
	for joint in bones.size():
		var at := 4 * joint
		var turn := Quaternion(turns[at + 1], turns[at + 2], turns[at + 3], turns[at])
		set_bone_pose_rotation(bones[joint], turn)


func send(message: Dictionary) -> void:
	socket.send(encode("AnimateRequest", message))


# Bytes of a message whose fields are given by name; only the kinds that are sent above.
func encode(kind: String, message: Dictionary) -> PackedByteArray:
	var out := PackedByteArray()
	for key: String in message:
		var field: Dictionary = layout.messages[kind][key]
		var repeated: bool = field.has("repeated")
		if repeated and field.repeated == "packed":
			var floats := PackedFloat32Array(message[key]).to_byte_array()
			out.append_array(varint(field.tag) + varint(floats.size()) + floats)
			continue
		for value: Variant in (message[key] if repeated else [message[key]]):
			out.append_array(varint(field.tag))
			if field.type == "message":
				var inner := encode(field.of, value)
				out.append_array(varint(inner.size()) + inner)
			else:
				out.append_array(varint(value))
	return out


func varint(value: int) -> PackedByteArray:
	var out := PackedByteArray()
	while value > 127:
		out.append(value & 127 | 128)
		value >>= 7
	out.append(value)
	return out


# A message as a dictionary by names; blocks of float32 as packed arrays, other numbers packed: left out.
func decode(kind: String, bytes: PackedByteArray) -> Dictionary:
	var by_tag := {}
	for key: String in layout.messages[kind]:
		by_tag[int(layout.messages[kind][key].tag)] = key
	var message := {}
	var at := 0
	while at < bytes.size():
		var tag := read_varint(bytes, at)
		at = tag.y
		var wire := tag.x & 7
		var length := Vector2i(0, at)
		if wire == 2:
			length = read_varint(bytes, at)
		elif wire == 0:
			length = Vector2i(read_varint(bytes, at).y - at, at)
		else:
			length = Vector2i(8 if wire == 1 else 4, at)
		var part := bytes.slice(length.y, length.y + length.x)
		at = length.y + length.x
		if not by_tag.has(tag.x):
			continue  # of a later version
		var key: String = by_tag[tag.x]
		var field: Dictionary = layout.messages[kind][key]
		var value: Variant = read(field, part)
		if field.has("repeated") and field.repeated != "packed":
			message[key] = message.get(key, []) + [value]
		else:
			message[key] = value
	return message


func read(field: Dictionary, part: PackedByteArray) -> Variant:
	if field.get("repeated", "") == "packed":
		return part.to_float32_array() if field.type == "float32" else null
	match field.type:
		"message":
			return decode(field.of, part)
		"string":
			return part.get_string_from_utf8()
		"float32":
			return part.decode_float(0)
		"float64":
			return part.decode_double(0)
		"bytes":
			return part
	return read_varint(part, 0).x


# The value and where it ends.
func read_varint(bytes: PackedByteArray, at: int) -> Vector2i:
	var value := 0
	var shift := 0
	while true:
		value |= (bytes[at] & 127) << shift
		shift += 7
		at += 1
		if bytes[at - 1] < 128:
			break
	return Vector2i(value, at)
