// Drives a rig of Unity from a Stridewire server over gRPC.
//
// Untested: no Unity was at hand where this was written. The messages' names are checked by a test.
//
//   1. stridewire serve
//   2. Unity 2022.3 or later. With NuGetForUnity install Google.Protobuf, Grpc.Net.Client and
//      Cysharp.Net.Http.YetAnotherHttpHandler (HTTP/2, which Unity's own HttpClient has not).
//   3. Make the messages, from the folder that holds `proto` (Grpc.Tools brings protoc and the plug-in):
//        protoc -Iproto --csharp_out=Assets/Stridewire --grpc_out=Assets/Stridewire
//          --plugin=protoc-gen-grpc=grpc_csharp_plugin proto/stridewire/v1/*.proto
//   4. stridewire stream --seconds 1 --out character.glb; import it with glTFast. Any other rig with the
//      joints' names does, if it stands where all local rotations are zero.
//   5. Put this component on its Armature node. WASD or the arrows move it, shift runs.
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Cysharp.Net.Http;
using Grpc.Core;
using Grpc.Net.Client;
using Stridewire.V1;
using UnityEngine;

public sealed class StridewireCharacter : MonoBehaviour
{
    public string address = "http://127.0.0.1:50051";
    public float walk = 1.4f;
    public float run = 3.2f;

    readonly ConcurrentQueue<AnimateResponse> received = new();
    readonly CancellationTokenSource ended = new();
    GrpcChannel channel;
    AsyncDuplexStreamingCall<AnimateRequest, AnimateResponse> stream;
    Task writing = Task.CompletedTask;
    Transform[] joints;
    uint step, lastFrame;

    async void Start()
    {
        var handler = new YetAnotherHttpHandler { Http2Only = true };
        channel = GrpcChannel.ForAddress(address, new GrpcChannelOptions { HttpHandler = handler, DisposeHttpClient = true });
        stream = new AnimationService.AnimationServiceClient(channel).Animate(cancellationToken: ended.Token);
        var open = new Open { Pacing = Pacing.Server };
        open.Characters.Add(new CharacterSpec { Id = 1 });
        Send(new AnimateRequest { Open = open });
        try
        {
            while (await stream.ResponseStream.MoveNext(ended.Token)) received.Enqueue(stream.ResponseStream.Current);
        }
        catch (RpcException error) when (error.StatusCode != StatusCode.Cancelled) { Debug.LogError(error.Status); }
        catch (RpcException) { }
    }

    void Update()
    {
        Frame newest = null;
        while (received.TryDequeue(out var message))
        {
            if (message.Opened != null) joints = Find(message.Opened.Skeleton.Joints);
            if (message.Error != null) Debug.LogWarning(message.Error);
            newest = message.Frame ?? newest;
        }
        if (newest != null && joints != null) Show(newest);
        if (joints != null && writing.IsCompleted) Steer();
    }

    // Controls by keys; a Step also acknowledges the newest frame.
    void Steer()
    {
        var way = new Vector2(-Input.GetAxisRaw("Horizontal"), Input.GetAxisRaw("Vertical")).normalized;  // +X is the left
        var speed = Input.GetKey(KeyCode.LeftShift) ? run : walk;
        var control = new Step { Step_ = ++step, LastFrame = lastFrame };
        control.VelocityXz.Add(speed * way.x);
        control.VelocityXz.Add(speed * way.y);
        Send(new AnimateRequest { Step = control });
    }

    // One write at a time, in order.
    void Send(AnimateRequest request) =>
        writing = writing.ContinueWith(_ => stream.RequestStream.WriteAsync(request), ended.Token).Unwrap();

    // The root moves this node, the hips and the rotations move the joints.
    void Show(Frame frame)
    {
        lastFrame = frame.Frame_;
        transform.SetPositionAndRotation(Position(frame.Root, 0), Rotation(frame.Root, 3));
        joints[0].localPosition = Position(frame.Hips, 0);
        for (var joint = 0; joint < joints.Length; joint++) joints[joint].localRotation = Rotation(frame.Rotations, 4 * joint);
    }

    // From ours, right-handed, to Unity's left-handed axes: x changes its sign, turns about y and z too.
    static Vector3 Position(IList<float> block, int at) => new(-block[at], block[at + 1], block[at + 2]);

    static Quaternion Rotation(IList<float> block, int at) =>
        new(block[at + 1], -block[at + 2], -block[at + 3], block[at]);

    Transform[] Find(IEnumerable<string> names)
    {
        var below = GetComponentsInChildren<Transform>().ToLookup(node => node.name);
        return names.Select(name => below[name].First()).ToArray();
    }

    void OnDestroy()
    {
        ended.Cancel();
        stream?.Dispose();
        channel?.Dispose();
    }
}
